#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backend/async_readback.hpp"
#include "backend/event.hpp"
#include "io/snapshot.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/motion/impulses.hpp"
#include "kernels/dem/motion/move.hpp"
#include "kernels/dem/motion/totals.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "solver/body_command.hpp"
#include "solver/body_ranks.hpp"
#include "solver/body_row.hpp"
#include "solver/device_rays.hpp"
#include "solver/device_templates.hpp"
#include "solver/ledger.hpp"
#include "solver/plan.hpp"
#include "solver/time_step.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

struct ContactCount
{
    double listed;
    double live;
    double nodes;
};

/// Rigid bodies of a scene on one backend: state, pairs, and the calls of a substep.
template<class Exec>
class DemSolver
{
public:
    /// `decomposition`: ownership of pages; null on one rank. With it every call is collective, and results cover all
    /// bodies.
    DemSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
              decomp::Decomposition<Exec>* decomposition = nullptr);

    dem::BodiesView          view() { return bodies_.view(); }
    const dem::TemplateView* templates() const { return templates_.views(); }
    dem::PairTable           pair_table() const { return law_.pairs; }

    /// Total mass, kg.
    double mass() const { return mass_; }

    /// Whether this rank shares bodies with others, so that every substep exchanges messages.
    bool shares() const { return ranks_ && ranks_->shares(); }

    /// Name for messages: that of a named body, or "rock 17".
    std::string name(std::int64_t body) const;

    /// Sets what the named bodies are held or driven to. A body that is freed for the first time starts with the
    /// scene's velocity, one that was lowered starts at rest.
    void command(const std::vector<BodyCommand>& commands);

    /// Step 2. Lists pairs of bodies, and of bodies and walls, that may touch within dt; rebuilds the list if the old
    /// one may have expired.
    void find_pairs(double dt);

    /// Passes changes made through view() on to the contacts. find_pairs and command do this themselves.
    void stage() { dem::stage_bodies(exec_, pairs_, bodies_.view()); }

    /// Returns the number of substeps that may be requested together, called before the substeps of a step. `speed`:
    /// m/s, the largest of anything; `contact_time`: s, the smallest sqrt(m / sum K) of a body, 0 = no contact. If the
    /// result is less than all substeps, find_pairs_if_displaced is due after each batch.
    std::int64_t substeps_without_check(const TimeStep& step, double speed, double contact_time);

    /// Call between two batches, after `done` substeps of a step that began at `time` (s). Rebuilds the pair list if
    /// the check requested before the last batch says that a body may move too far in the next; if not, requests the
    /// check for the next two batches, so that the backend computes during the readback.
    void find_pairs_if_displaced(const TimeStep& step, std::int64_t batch, std::int64_t done, double time);

    /// Number of steps of dt (s) for which the pair list needs no check; at least one.
    std::int64_t steps_without_check(double dt, double speed) const;

    /// Returns and resets the largest speed (m/s) set by commands on any rank since the last call.
    double take_commanded_speed() { return of_all(std::exchange(commanded_speed_, 0.0)); }

    /// Partition version: the bodies on this rank stay the same while it is unchanged. 0 on one rank.
    std::int64_t partition_version() const { return partition_version_; }

    /// Predicted work of the bodies that this rank owns, in points, on several ranks; add_loads adds it to their
    /// pages.
    double load() const { return ranks_->load(); }
    void   add_loads(decomp::PageLoads& loads) const { ranks_->add_loads(bodies_, loads); }

    /// Minimum over bodies of sqrt(m / sum K), s, over contacts that are live or may begin in the step; 0 = none.
    double shortest_contact();

    /// Throws NumericalError: a step would take too many substeps; names the body that demands them.
    [[noreturn]] void refuse_substeps(const TimeStep& step, const Pace& pace, double time);

    /// Counts listed pairs, those of them that touch, and listed nodes; synchronises.
    ContactCount count_contacts();

    // Step 3. One substep.
    void contact(double dt);
    void move(double dt, double damping, const dem::OutsideWrenches& outside = {});
    /// Calls contact and move `count` times, for bodies that touch only each other and walls.
    void run(double dt, double damping, std::int64_t count);

    /// Data that a launch of whole substeps needs; its caller then reports how many it did.
    dem::BodyStep<Exec> body_step(double dt, double damping);
    void                count_substeps(double dt, std::int64_t count);

    /// Report of the step; synchronises. NumericalError when a contact is deeper than its law allows, or a body's
    /// position is not finite; `time` (s) is for that message.
    RigidReport report(double time);

    /// Requests the report early, so that one synchronisation serves several readbacks.
    void request_report();

    /// Records of the pairs that touched in the last step.
    std::vector<world::ContactRecord> contacts() const;

    RigidCensus          census();
    std::vector<BodyRow> named_bodies();
    void                 begin_mean();
    io::BodyFields       fields();

    /// m, centre of a named body.
    Vec3<double> place(std::size_t body) const;

    /// s, integral over time since the run began of the share of a named body's weight that its contacts carried.
    double carried(std::size_t body) const;

    /// Saves the state to a checkpoint, or loads it into bodies of the same scene; call between two steps. Does not
    /// change later results. Contact energies are available again after the next substep.
    void transfer(StateFile& file);

private:
    void transfer_bodies(StateFile& file);
    void transfer_commands(StateFile& file);
    void transfer_means(StateFile& file);
    void transfer_contacts(StateFile& file);
    void transfer_lists(StateFile& file);

    dem::NamedImpulses named_impulses() { return {impulses_.data(), named_}; }

    Vec3<double> commanded_velocity(std::size_t body, const std::optional<BodyCommand>& before, Vec3<double> velocity);
    bool         set_motion(std::size_t body, const std::optional<BodyCommand>& before);

    std::vector<dem::ContactImpulse> summed_impulses() const;

    void          upload(const world::World& world);
    void          restore_contacts();
    void          list_pairs_anew(double dt);
    bool          list_holds(double dt);
    const double* largest_displacement_ahead(double ahead);
    void          request_lookahead(double ahead);
    bool          is_displaced_too_far();
    void          find_pairs_within(const TimeStep& step, double time);
    void          check(RigidReport& report, double sum_of_speeds, double time);
    void          add_up(RigidReport& report) const;

    dem::SharedView shared() { return ranks_ ? ranks_->shared() : dem::SharedView{}; }
    double          of_all(double value) const { return ranks_ ? ranks_->largest(value) : value; }

    /// Runs checks of this rank's bodies; an error on one rank is thrown on all.
    template<class Checks>
    void together(Checks checks) const
    {
        if (ranks_) { on_every_rank(ranks_->communicator(), checks); }
        else { checks(); }
    }
    void require_finite(double time);
    void require_listed(double time, double stray);
    void require_resolved(double time, double speed);
    void take(const dem::BodyTotal& now, RigidReport& report);

    /// Sums and maxima over all bodies.
    struct ReportSums
    {
        dem::BodyActivity most;
        dem::BodyActivity all;
        dem::BodyTotal    total;
    };
    double guard(double time, double overlap);

    Exec                                          exec_;
    const scene::Scene&                           scene_;
    const world::World&                           world_;
    Vec3<double>                                  gravity_;
    double                                        mass_ = 0;
    std::int64_t                                  named_;
    bool                                          contacts_; ///< whether a body may touch another or a wall
    DeviceTemplates<Exec>                         templates_;
    DeviceRays<Exec>                              rays_;
    dem::Bodies<Exec>                             bodies_;
    dem::Pairs<Exec>                              pairs_;
    Array<Exec, dem::PairProperties>              properties_;
    Array<Exec, dem::Plane>                       planes_;
    dem::BodyTotals<Exec>                         totals_;
    Array<Exec, dem::ContactImpulse>              impulses_; ///< impulses of the named bodies since begin_mean()
    Array<Exec, double>                           bounding_radii_;
    Array<Exec, double>                           sums_;     ///< ReportSums
    std::optional<Array<Exec, dem::BodyActivity>> activity_; ///< activity for the requested report
    AsyncReadback<Exec, ReportSums>               readback_;
    AsyncReadback<Exec, double>                   displacement_readback_;
    AsyncReadback<Exec, double>                   overlap_readback_;
    AsyncReadback<Exec, double>                   lookahead_readback_;
    Event<Exec>                                   lookahead_done_;
    dem::DisplacementTracker<Exec>                displacements_;
    double                                        smallest_radius_   = 0;     ///< m, of the bounding spheres
    bool                                          listed_            = false; ///< whether pairs were found
    std::int64_t                                  partition_version_ = 0;
    double                                        span_              = 0; ///< s, span of the last search for pairs
    bool                                    checked_within_step_ = false; ///< the list is also checked within the step
    bool                                    lookahead_pending_   = false; ///< a check was requested and not used yet
    double                                  commanded_speed_     = 0;     ///< m/s, largest speed set by commands
    double                                  overlap_ = 0; ///< largest over radius, before the list was rebuilt
    dem::BodyLaw                            law_{};
    std::vector<bool>                       released_;            ///< named bodies that have been free before
    std::vector<std::optional<BodyCommand>> commanded_;           ///< last command of each named body
    double                                  heaviest_  = 1;       ///< largest share of a body's weight that acts
    double                                  mean_time_ = 0;       ///< s, since begin_mean()
    std::vector<Vec3<double>>               kept_impulses_;       ///< N s, of the named bodies, until begin_mean()
    double                                  substep_         = 0; ///< s, duration of the last substep
    double                                  command_work_    = 0; ///< J, work of commands since the last report
    Vec3<double>                            command_impulse_ = Vec3<double>::Zero();
    dem::BodyTotal                          taken_{}; ///< totals at the last report
    std::optional<BodyRanks<Exec>>          ranks_;
};

} // namespace tread::solver
