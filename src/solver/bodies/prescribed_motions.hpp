#pragma once

#include <vector>

#include "kernels/dem/motion/prescribed.hpp"
#include "solver/bodies/body_command.hpp"
#include "solver/bodies/body_state.hpp"

namespace tread::solver
{

/// Prescribed motions of the named bodies on the backend, and the impulses of their reactions.
template<class Exec>
class PrescribedMotions
{
public:
    PrescribedMotions(const Exec& exec, std::int64_t named);

    /// Takes the motions of these commands, one for each named body; returns the largest speed (m/s, of a body's
    /// surface) that a motion prescribes, less rounding, so that a speed which was measured does not exceed itself; 0
    /// if none. Copies only what has changed.
    double set(const BodyState<Exec>& state, const std::vector<BodyCommand>& commands);

    dem::PrescribedView view() { return {motions_.data(), reactions_.data()}; }

    /// Mean reactions since begin_mean(): force (N) and torque (N m) on each named body, world frame; `time`: s, since
    /// then. Collective.
    std::vector<dem::ContactImpulse> mean_reactions(const BodyState<Exec>& state, double time) const;
    void                             begin_mean() { reactions_.fill_zero(); }

    /// Saves or loads the impulses; loading a state of other ranks adds up what each of them has recorded.
    void transfer(StateFile& file);

private:
    Exec                             exec_;
    std::vector<dem::Prescribed>     present_; ///< what motions_ holds
    Array<Exec, dem::Prescribed>     motions_;
    Array<Exec, dem::ContactImpulse> reactions_; ///< of the bodies that this rank owns
};

} // namespace tread::solver
