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

/// The rigid bodies of a scene on one backend: their state, their pairs, and the calls of a substep.
template<class Exec>
class DemSolver
{
public:
    /// `decomposition`: who owns which page; null on one rank. With it every call is collective, and what comes back is
    /// of all bodies.
    DemSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
              decomp::Decomposition<Exec>* decomposition = nullptr);

    dem::BodiesView          view() { return bodies_.view(); }
    const dem::TemplateView* templates() const { return templates_.views(); }
    dem::PairTable           pair_table() const { return law_.pairs; }

    /// Total mass, kg.
    double mass() const { return mass_; }

    /// Whether this rank moves bodies together with others, so that every substep has messages.
    bool shares() const { return ranks_ && ranks_->shares(); }

    /// For messages: a named body's name, or "rock 17".
    std::string name(std::int64_t body) const;

    /// Sets what the named bodies are held or driven to. A body that is freed for the first time starts with its
    /// scene's velocity, one that was lowered at rest.
    void command(const std::vector<BodyCommand>& commands);

    /// 2. Pairs of bodies, and of bodies and walls, that may touch in the step: found anew if the list may not hold.
    void find_pairs(double dt);

    /// Shows the contacts what somebody else has changed in view() since. find_pairs and command do.
    void stage() { dem::stage_bodies(exec_, pairs_, bodies_.view()); }

    /// Before the substeps of a step, when the fastest of anything goes at `speed` (m/s) and the shortest sqrt(m / sum
    /// K) of a body is `contact_time` (s; 0 = no contact): the batch, of how many substeps may be asked for together.
    /// Fewer than all: find_pairs_if_displaced is due in between.
    std::int64_t substeps_without_check(const TimeStep& step, double speed, double contact_time);

    /// Between two batches, when so many substeps are done of a step that began at `time` (s): finds the pairs anew if
    /// the look from before the last batch says that a body may go too far in the next; if not, asks for another look,
    /// for the next two. So the backend has a batch to work on while an answer travels.
    void find_pairs_if_displaced(const TimeStep& step, std::int64_t batch, std::int64_t done, double time);

    /// After how many steps of dt (s) the list of pairs should be looked at again: one, unless find_pairs allowed for
    /// more of them without a watch.
    std::int64_t steps_without_check(double dt, double speed) const;

    /// m/s, the largest that commands have given since the last call, on any rank.
    double take_commanded_speed() { return of_all(std::exchange(commanded_speed_, 0.0)); }

    /// How often bodies were dealt to the ranks: which of them are here stays while this does. 0 on one rank.
    std::int64_t partition_version() const { return partition_version_; }

    /// Predicted work of the bodies that this rank owns, in points, on several ranks; added to the pages that they are
    /// on.
    double load() const { return ranks_->load(); }
    void   add_loads(decomp::PageLoads& loads) const { ranks_->add_loads(bodies_, loads); }

    /// The least sqrt(m / sum K) over bodies, of contacts that are live or may come in the step, s; 0 = none.
    double shortest_contact();

    /// NumericalError: a step would take too many substeps, and which body wants them.
    [[noreturn]] void refuse_substeps(const TimeStep& step, const Pace& pace, double time);

    /// Pairs that are listed, those of them that touch, and the nodes that are listed; waits for them.
    ContactCount count_contacts();

    // 3. A substep.
    void contact(double dt);
    void move(double dt, double damping, const dem::OutsideWrenches& outside = {});
    /// contact and move, `count` times: of bodies that meet nothing but each other and walls.
    void run(double dt, double damping, std::int64_t count);

    /// What a substep of bodies needs, for those who do it for them, and then say how many they did.
    dem::BodyStep<Exec> body_step(double dt, double damping);
    void                count_substeps(double dt, std::int64_t count);

    /// Of the step; waits for it. NumericalError when a contact is deeper than the law can carry, or a body is not at a
    /// finite place: `time` (s) is for that message.
    RigidReport report(double time);

    /// Asks for the report already, so that one wait serves others' too.
    void request_report();

    /// Of the pairs of the last step that touch.
    std::vector<world::ContactRecord> contacts() const;

    RigidCensus          census();
    std::vector<BodyRow> named_bodies();
    void                 begin_mean();
    io::BodyFields       fields();

    /// m, centre of a named body.
    Vec3<double> place(std::size_t body) const;

    /// s, the integral over time since the run began of the share of a named body's weight that its contacts carried.
    double carried(std::size_t body) const;

    /// Into a checkpoint, or out of it into bodies of the same scene; due between two steps, and changes nothing that
    /// comes after it. Contact energies are known again after the next substep.
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

    /// Checks of this rank's bodies: what one rank throws, all do.
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

    /// Over all bodies.
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
    bool                                          contacts_; ///< some body may meet another or a wall
    DeviceTemplates<Exec>                         templates_;
    DeviceRays<Exec>                              rays_;
    dem::Bodies<Exec>                             bodies_;
    dem::Pairs<Exec>                              pairs_;
    Array<Exec, dem::PairProperties>              properties_;
    Array<Exec, dem::Plane>                       planes_;
    dem::BodyTotals<Exec>                         totals_;
    Array<Exec, dem::ContactImpulse>              impulses_; ///< of the named bodies, since begin_mean()
    Array<Exec, double>                           bounding_radii_;
    Array<Exec, double>                           sums_;     ///< ReportSums
    std::optional<Array<Exec, dem::BodyActivity>> activity_; ///< of the report that was asked for
    AsyncReadback<Exec, ReportSums>               readback_;
    AsyncReadback<Exec, double>                   displacement_readback_;
    AsyncReadback<Exec, double>                   overlap_readback_;
    AsyncReadback<Exec, double>                   lookahead_readback_;
    Event<Exec>                                   lookahead_done_;
    dem::DisplacementTracker<Exec>                displacements_;
    double                                        smallest_radius_   = 0;     ///< m, of the bounding spheres
    bool                                          listed_            = false; ///< pairs were found
    std::int64_t                                  partition_version_ = 0;
    double                                        span_              = 0; ///< s, that pairs were last found for
    bool                                    checked_within_step_ = false; ///< of the present step: not only at its end
    bool                                    lookahead_pending_ = false; ///< a look was asked for, and nobody heeded it
    double                                  commanded_speed_   = 0;     ///< m/s, the largest that commands gave
    double                                  overlap_ = 0; ///< largest over radius, before the list was found anew
    dem::BodyLaw                            law_{};
    std::vector<bool>                       released_;            ///< named bodies that were free once
    std::vector<std::optional<BodyCommand>> commanded_;           ///< of the named bodies, the last
    double                                  heaviest_  = 1;       ///< largest share of a weight that acts
    double                                  mean_time_ = 0;       ///< s, since begin_mean()
    std::vector<Vec3<double>>               kept_impulses_;       ///< N s, of the named bodies, until begin_mean()
    double                                  substep_         = 0; ///< s, the last
    double                                  command_work_    = 0; ///< J, of commands since the last report
    Vec3<double>                            command_impulse_ = Vec3<double>::Zero();
    dem::BodyTotal                          taken_{}; ///< totals at the last report
    std::optional<BodyRanks<Exec>>          ranks_;
};

} // namespace tread::solver
