#pragma once

#include <string>
#include <vector>

#include "kernels/dem/motion/move.hpp"
#include "solver/bodies/body_state.hpp"

namespace tread::solver
{

/// Contact impulses on the named bodies, for the mean forces of the recorder and the weight that the ground carries.
template<class Exec>
struct NamedMeans
{
    NamedMeans(const Exec& exec, std::int64_t named);

    /// View for the substeps, which add to the impulses.
    dem::NamedImpulses view() { return {impulses.data(), impulses.size()}; }

    /// Saves or loads the impulses; loading a state of other ranks adds up what each of them has recorded. `time`
    /// is in bodies/steps.
    void transfer(StateFile& file);

    Array<Exec, dem::ContactImpulse> impulses; ///< of this rank's contacts, since begin_mean()
    std::vector<Vec3<double>>        kept;     ///< N s, linear impulses of all ranks until begin_mean()
    double                           time = 0; ///< s, since begin_mean()
};

/// Saves or loads impulses on the `named` bodies; loading a state of other ranks adds up what each of them has
/// recorded.
template<class Exec>
void transfer_impulses(StateFile& file, const std::string& name, std::size_t named,
                       Array<Exec, dem::ContactImpulse>& impulses);

/// Begins a new span for the means. Collective.
template<class Exec>
void begin_mean(const BodyState<Exec>& state, NamedMeans<Exec>& means);

/// Impulses of all ranks' contacts since begin_mean(). Collective.
template<class Exec>
std::vector<dem::ContactImpulse> summed_impulses(const BodyState<Exec>& state, const NamedMeans<Exec>& means);

/// N s, impulse of a named body's contacts since the run began. Collective.
template<class Exec>
Vec3<double> contact_impulse(const BodyState<Exec>& state, const NamedMeans<Exec>& means, std::size_t body);

/// s, integral over time since the run began of the share of a named body's weight that its contacts carried.
/// Collective.
template<class Exec>
double carried(const BodyState<Exec>& state, const NamedMeans<Exec>& means, std::size_t body);

} // namespace tread::solver
