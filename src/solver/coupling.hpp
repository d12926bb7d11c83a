#pragma once

#include "decomp/decomposition.hpp"
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
             dem::PairTable pairs, decomp::Decomposition<Exec>* decomposition = nullptr);

    /// Collective, on several ranks: what contacts remember of points goes to the ranks that these (by id, ascending,
    /// of each rank) have gone to.
    void send_after(const std::vector<std::vector<std::uint32_t>>& departed);

    /// 2. Candidates of the step; nothing moves further in it than `speed` allows.
    void begin_step(const mpm::PointsView<Real>& points, const mpm::PagesView& pages, const dem::BodiesView& bodies,
                    double dt, double speed);

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

    /// Of the last substep (dissipated: of the step); waits for it.
    const contact::Summary& summary() const { return summary_; }

private:
    Exec                        exec_;
    contact::PointContact<Exec> contact_;
    contact::PointBodyLaw       law_;
    double                      largest_radius_;
    contact::Summary            summary_ = contact::Summary::zero();
    const Communicator*         communicator_; ///< null on one rank
};

} // namespace tread::solver
