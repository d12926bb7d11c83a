#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "run/time_loop.hpp"
#include "run/visit.hpp"

namespace tread::run
{

/// What a visitor has set; on several ranks rank 0's counts.
struct Steering
{
    std::vector<std::optional<BodySteering>>  bodies; ///< of the named bodies, until the phase ends
    std::vector<std::optional<MotorSteering>> motors; ///< of the joints, since the visit began
};

/// Impulses of the contacts of the named bodies (N s) at a visit.
struct VisitedImpulses
{
    double                    time = 0; ///< s
    std::vector<Vec3<double>> of;       ///< empty before the first visit
};

/// Calls the visitor of a run when that is due, and steers as it has asked. A run whose visitor only looks takes the
/// same steps as one without: visits wait for a measured state. Collective.
template<class Exec, class Real>
class Visits
{
public:
    /// All must outlive this.
    Visits(const Communicator& communicator, Log& log, const world::World& world, const solver::Plan& plan,
           const Visitor& visitor, TimeLoop<Exec, Real>& loop);

    /// Call before a step: visits if that is due; returns the reason if the visitor of any rank wants to stop.
    std::optional<std::string> visit_if_due();

    /// Visits when all phases ran.
    void visit_last();

    /// Changes the commands of the named bodies for the next step.
    void steer(std::vector<solver::BodyCommand>& commands) const;

private:
    bool                       is_due() const;
    std::optional<std::string> visit();
    void                       agree();
    void                       apply();

    const Communicator&   communicator_;
    Log&                  log_;
    const world::World&   world_;
    solver::Plan          plan_;
    Visitor               visitor_;
    TimeLoop<Exec, Real>& loop_;
    Steering              steering_;
    VisitedImpulses       impulses_;
    std::size_t           phase_; ///< of the last visit; number of phases: none yet
    std::int64_t          spans_       = 0;
    std::int64_t          last_step_   = 0;
    bool                  was_steered_ = false;
    double                bound_; ///< m/s2, of the scene's own motions
};

} // namespace tread::run
