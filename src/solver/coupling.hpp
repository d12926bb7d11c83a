#pragma once

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/move.hpp"
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

    /// 2. Candidates of the step; nothing moves further in it than `speed` allows.
    void begin_step(const mpm::PointsView<Real>& points, const mpm::PagesView& pages, const dem::BodiesView& bodies,
                    double dt, double speed);

    /// Forces on bodies, and the private points' motion over a substep.
    void substep(const dem::BodiesView& bodies, double dt);

    /// Of the last substep.
    dem::OutsideWrenches wrenches() const { return contact_.wrenches(); }

    /// All of `count` substeps, contacts of bodies and their motion included, if one launch is worth it: says whether.
    bool run_in_one_launch(dem::BodyStep<Exec> step, std::int64_t count);

    /// Impulses become the points' contact force.
    void finish_step(const mpm::PointsView<Real>& points, double dt);

    /// Of the last substep (dissipated: of the step); waits for it.
    const contact::Summary& summary() const { return summary_; }

private:
    Exec                        exec_;
    contact::PointContact<Exec> contact_;
    contact::PointBodyLaw       law_;
    double                      largest_radius_;
    contact::Summary            summary_ = contact::Summary::zero();
};

} // namespace tread::solver
