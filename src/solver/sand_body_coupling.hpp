#pragma once

#include "backend/async_readback.hpp"
#include "decomp/decomposition.hpp"
#include "kernels/contact/substeps.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// How many there are of what contacts name.
struct ContactPartners
{
    std::size_t bodies;
    std::size_t points; ///< of this rank, awake: places in memory
    std::size_t ids;    ///< of the scene
};

/// Contact of the sand with the bodies of a scene, on one backend.
template<class Exec, class Real>
class SandBodyCoupling
{
public:
    SandBodyCoupling(const Exec& exec, const scene::Scene& scene, const world::World& world,
                     const dem::TemplateView* templates, dem::PairTable pairs,
                     decomp::Decomposition<Exec>* decomposition = nullptr);

    /// Collective, on several ranks: what contacts remember of points goes to the ranks that these (by id, ascending,
    /// of each rank) have gone to.
    void send_records_after(const std::vector<std::vector<std::uint32_t>>& migrated_out);

    /// 2. Candidates of the next steps, of `span` (s) in all: found anew if the last ones may not hold. `version` says
    /// which points, in which places of memory, and which bodies are here. No point or body is faster than `speed`
    /// (m/s) now, nor will be twice as fast.
    void find_candidates(const mpm::PointsView<Real>& points, const mpm::PagesView& pages,
                         const dem::BodiesView& bodies, std::int64_t version, double span, double speed);

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

    /// Takes stock of the last substep, of all ranks; waits for it.
    void measure();

    /// Asks for that already, so that one wait serves others' too.
    void request_measure();

    /// As last measured (dissipated: since the time before that).
    const contact::Summary& summary() const { return summary_; }

    /// What contacts remember, and the candidates, into a checkpoint or out of it, after the sand and the bodies.
    void transfer(StateFile& file, const dem::BodiesView& bodies, const ContactPartners& partners);

private:
    bool any_near() const { return contact_.candidates.body.size() > 0; }

    std::vector<contact::HistoryRecord> remembered();

    void transfer_records(StateFile& file, std::vector<contact::HistoryRecord>& records,
                          const ContactPartners& partners);
    void transfer_candidates(StateFile& file, const dem::BodiesView& bodies, const ContactPartners& partners);
    void transfer_slots(StateFile& file, const ContactPartners& partners);

    Exec                                  exec_;
    contact::PointContact<Exec>           contact_;
    contact::PointBodyLaw                 law_;
    double                                largest_radius_;
    double                                skin_;            ///< m
    double                                used_    = 0;     ///< m of it, since the search
    std::int64_t                          version_ = 0;     ///< at the search; 0 = none yet
    bool                                  begun_   = false; ///< by the search
    std::int64_t                          named_; ///< bodies, the first ones, whose contacts are counted apart
    contact::Summary                      summary_ = contact::Summary::zero();
    AsyncReadback<Exec, contact::Summary> readback_;
    bool                                  requested_ = false; ///< for the next summary
    const Communicator*                   communicator_;      ///< null on one rank
};

} // namespace tread::solver
