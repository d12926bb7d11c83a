#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "run/visit.hpp"
#include "solver/simulation.hpp"

namespace tread::run
{

/// Fields of a simulation as host arrays: views of its memory on a CPU, copies on a GPU and of sand that may sleep,
/// which lies in two places. Names are "points.position", "bodies.velocity", "contacts.force" ... (docs/python.md).
template<class Exec, class Real>
class VisitedArrays
{
public:
    /// `simulation` must outlive this. `moved`: whether it has taken a step; before that contacts have no forces.
    VisitedArrays(solver::Simulation<Exec, Real>& simulation, const solver::Plan& plan, bool moved);

    /// Empty for a field that the scene does not have. InputError for a name that no scene has.
    std::optional<HostArray> find(const std::string& name);

private:
    using Points = mpm::Points<Exec, Real>;

    std::optional<HostArray> point_field(const std::string& name);
    std::optional<HostArray> body_field(const std::string& name);
    std::optional<HostArray> contact_field(const std::string& name);

    template<class T>
    HostArray planes(Array<Exec, T> Points::*member, std::int64_t components);
    template<class T>
    HostArray  rows(const Array<Exec, T>& array);
    std::byte* room(std::size_t bytes);

    solver::Simulation<Exec, Real>&     simulation_;
    solver::Plan                        plan_;
    bool                                moved_;
    std::vector<std::vector<std::byte>> copies_; ///< which arrays point to
};

} // namespace tread::run
