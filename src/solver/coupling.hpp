#pragma once

#include "kernels/contact/substeps.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

/// Contact of the sand with the bodies of a scene, on one backend.
template<class Exec, class Real>
class Coupling
{
public:
    Coupling(const Exec& exec, const scene::Scene& scene, const World& world, const dem::TemplateView* templates,
             dem::PairTable pairs);

    /// 2. Candidates of the next steps, of `span` (s) in all, of sand that was ordered in memory `orders` times: found
    /// anew if the last ones may not hold. No point or body is faster than `speed` (m/s) now, nor will be twice as
    /// fast.
    void find_candidates(const mpm::PointsView<Real>& points, const mpm::PagesView& pages,
                         const dem::BodiesView& bodies, std::int64_t orders, double span, double speed);

    /// Shows the contacts what a step did to their points, unless find_candidates has just done so.
    void begin_step(const mpm::PointsView<Real>& points);

    /// Forces on bodies, and the private points' motion over a substep.
    void substep(const dem::BodiesView& bodies, double dt);

    /// Of the last substep.
    dem::OutsideWrenches wrenches() const { return contact_.wrenches(); }

    /// Whether one launch for all substeps of a step is worth it.
    bool worth_one_launch(const dem::BodyStep<Exec>& step) { return contact::worth_one_launch(exec_, contact_, step); }

    /// `count` substeps in it, contacts of bodies and their motion included.
    void run_substeps(dem::BodyStep<Exec> step, std::int64_t count);

    /// Impulses become the points' contact force.
    void finish_step(const mpm::PointsView<Real>& points, double dt);

    /// Takes stock of the last substep; waits for it.
    void measure() { summary_ = contact::summarise(exec_, contact_); }

    /// As last measured (dissipated: since the time before that).
    const contact::Summary& summary() const { return summary_; }

private:
    Exec                        exec_;
    contact::PointContact<Exec> contact_;
    contact::PointBodyLaw       law_;
    double                      largest_radius_;
    double                      skin_;            ///< m
    double                      used_    = 0;     ///< m of it, since the search
    std::int64_t                orders_  = 0;     ///< of the sand at the search; 0 = none yet
    bool                        begun_   = false; ///< by the search
    contact::Summary            summary_ = contact::Summary::zero();
};

} // namespace tread::solver
