#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/snapshot.hpp"
#include "kernels/dem/motion/move.hpp"
#include "solver/bodies/body_command.hpp"
#include "solver/bodies/body_commands.hpp"
#include "solver/bodies/body_joints.hpp"
#include "solver/bodies/body_output.hpp"
#include "solver/bodies/body_reports.hpp"
#include "solver/bodies/body_row.hpp"
#include "solver/bodies/body_sleep.hpp"
#include "solver/bodies/body_state.hpp"
#include "solver/bodies/body_touch.hpp"
#include "solver/bodies/named_means.hpp"
#include "solver/bodies/pair_lists.hpp"
#include "solver/bodies/prescribed_motions.hpp"
#include "solver/ledger/ledger.hpp"
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

/// Rigid bodies of a scene on one backend: puts together the parts that work on a BodyState. Its part in a step, by the
/// numbers of ARCHITECTURE.md, is
///
/// - 1, command: BodyCommands set what named bodies are held or driven to;
/// - 3, find_pairs: PairLists renew the list of pairs;
/// - 4, begin_substeps, then contact and move, or run; take_done, and find_pairs_if_displaced where fewer substeps were
///   done than requested;
/// - 7, request_report and report: BodyReports sum up the steps since the last report.
///
/// Output is named_bodies, fields, census and contacts (body_output.hpp, contact_records.hpp).
template<class Exec>
class DemSolver
{
public:
    /// `decomposition`: ownership of pages; null on one rank. With it every call is collective, and results cover all
    /// bodies.
    DemSolver(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan,
              decomp::Decomposition<Exec>* decomposition = nullptr);

    dem::BodiesView          view() { return state_.view(); }
    const dem::Bodies<Exec>& bodies() const { return state_.bodies; }
    const dem::Pairs<Exec>&  pairs() const { return state_.pairs; }
    const dem::TemplateView* templates() const { return state_.tables.law.templates; }
    dem::PairTable           pair_table() const { return state_.tables.law.pairs; }

    /// Total mass, kg.
    double mass() const { return state_.mass; }

    /// Whether this rank shares bodies with others, so that every substep exchanges messages.
    bool shares() const { return state_.shares(); }

    /// Numbers of the bodies that this rank has rows for.
    const BodyNumbers& numbers() const { return state_.numbers(); }

    /// Material of each body that this rank has a row for.
    BodyMaterials materials() const { return {state_.numbers(), state_.bodies.material.to_host()}; }

    /// m, distance of each row's body from its centre to its farthest point.
    std::vector<double> bounding_radii() const { return state_.tables.bounding_radii.to_host(); }

    /// Change of rows when owners were assigned last; null where there was none.
    const RowMoves<Exec>* row_moves() const { return state_.row_moves(); }

    /// Name for messages: that of a named body, or "rock 17".
    std::string name(std::int64_t number) const { return state_.name_of_number(number); }

    /// Counts the lists of pairs.
    std::int64_t list_version() const { return lists_.version; }

    /// Partition version: the bodies on this rank stay the same while it is unchanged. 0 on one rank.
    std::int64_t partition_version() const { return state_.ranks ? lists_.version : 0; }

    /// What the present list allows each body; nothing where no list is kept.
    dem::ListedPlaces listed() const { return state_.has_contact ? lists_.places(state_) : dem::ListedPlaces{}; }

    /// Predicted work of the bodies that this rank owns, in points, on several ranks; add_loads adds it to their
    /// pages.
    double load() const { return state_.ranks->load(state_.pairs.sleep.here); }
    void   add_loads(decomp::PageLoads& loads) const { state_.ranks->add_loads(state_.bodies, loads); }

    /// Step 1. Sets what the named bodies are held or driven to (apply_commands).
    void command(const std::vector<BodyCommand>& commands);

    /// Step 1. Sets the motors of joints to a phase of the scene.
    void begin_phase(std::size_t phase);

    /// Sets the motor of a joint (BodyJoints::set_motor).
    void set_motor(std::size_t joint, double speed, std::optional<double> most_torque);

    /// Raises the bound (m/s2) on what prescribed forces cause at any point of a body; returns by how much.
    double expect_acceleration(double acceleration);

    /// Sets gravity, m/s2, and the properties of contacts to those of a phase of the scene.
    void set_gravity(const Vec3<double>& gravity) { state_.gravity = gravity; }
    void set_contacts(std::size_t phase);

    /// Sets the largest factor on the inertia of rocks to that of a phase of the scene; returns whether it is another
    /// one, so that a shortest_contact() of before holds no more. From where it is 1, factors only decay.
    bool set_mass_scaling(std::size_t phase);

    /// Sets the damping of the phase; no rock falls asleep where there is any.
    void set_damping(double damping) { sleep_.damping = damping; }

    /// Mean share of the rocks that have slept so far; empty where none may.
    std::optional<double> mean_asleep() const { return solver::mean_asleep(state_); }

    /// Number of rocks that sleep.
    std::int64_t asleep() const { return static_cast<std::int64_t>(state_.pairs.sleep.count); }

    /// Sleeping rocks, where rocks may sleep.
    dem::SleepingBodies<Exec>& sleepers() { return state_.pairs.sleep; }

    /// Whether the list of pairs is that of the present bodies, though it may have expired.
    bool has_list() const { return lists_.listed; }

    /// Has rocks follow the sand around them (follow_beds), after sleepers().next_bed has been written.
    void follow_beds() { solver::follow_beds(state_, lists_, reports_, substep_); }

    /// Begins new references of loads (dem::renew_watches).
    void renew_watches() { dem::renew_watches(state_.exec, state_.pairs); }

    /// Call after the wrenches of sleeping sand on sleeping rocks, sleepers().sand, have changed.
    void hold_sleepers() { dem::hold_sleepers(state_.exec, state_.pairs, state_.view()); }

    /// Has the next find_pairs list pairs anew, as where others touch from now on.
    void forget_list() { lists_.listed = false; }

    /// Energies of contacts by pair of materials, and a check of pairs that begin to touch (body_touch.hpp).
    void add_contact_energies(std::size_t sides, std::vector<double>& energies) const
    {
        solver::add_contact_energies(state_, sides, energies);
    }
    void require_apart(const TouchChange& change, std::size_t phase, double time)
    {
        solver::require_apart(state_, change, phase, time);
    }

    /// Returns and resets the largest speed (m/s) set by commands on any rank since the last call.
    double take_commanded_speed();

    /// Step 3. Lists pairs of bodies, and of bodies and walls, that may touch within dt (update_pairs). Rocks fall
    /// asleep and wake here. Returns whether pairs were found anew.
    bool find_pairs(double dt);

    /// Passes changes made through view() on to the contacts. command does so itself, and find_pairs where it lists
    /// anew.
    void stage()
    {
        state_.stage();
        nodes_evaluated_ = false;
    }

    /// Minimum over bodies of sqrt(m / sum K), s, over contacts that are live or may begin in the step; 0 = none.
    double shortest_contact();

    /// Throws NumericalError: a step would take too many substeps; names the body that demands them.
    [[noreturn]] void refuse_substeps(const TimeStep& step, const Pace& pace, double time);

    /// Number of steps of dt (s) for which the pair list needs no check; at least one. `speed`: m/s, the largest of
    /// anything.
    std::int64_t steps_without_check(double dt, double speed) const;

    /// Begins the substeps of a step. `speed`: m/s, the largest of anything; `contact_time`: s, the smallest
    /// sqrt(m / sum K) of a body, 0 = no contact. All may be requested together, on several ranks until must_agree().
    void begin_substeps(const TimeStep& step, double speed, double contact_time);

    /// Number of substeps that may be requested until several ranks must agree whether the pair list has expired, and
    /// whether they must now, by agree_on_list(), which is collective.
    std::int64_t until_agreement() const { return state_.ranks ? lists_.until_look() : PairLists<Exec>::endless; }
    bool         must_agree() const { return state_.ranks && lists_.has_looked(); }
    void         agree_on_list() { solver::agree_on_list(state_, lists_); }

    /// Call where take_done() was fewer than requested, after `done` substeps of a step that began at `time` (s).
    /// Rebuilds the pair list if it has expired, and returns whether it has.
    bool find_pairs_if_displaced(const TimeStep& step, std::int64_t done, double time);

    /// Step 4. Call before the substeps of a step, and where the pair list was rebuilt in it.
    void list_moved(const dem::OutsideWrenches& outside);

    // Step 4. One substep.
    void contact(double dt);
    void move(double dt, double damping, const dem::OutsideWrenches& outside = {});
    /// Calls contact and move `count` times, for bodies that touch only each other and walls.
    void run(double dt, double damping, std::int64_t count);

    /// Tag for launches of the substeps: they do nothing once the list of pairs has expired.
    Exec substep_exec();

    /// Data that a launch of whole substeps needs, `count` of which its caller then says to have requested.
    dem::BodyStep<Exec> body_step(double dt, double damping);
    void                requested(std::int64_t count)
    {
        lists_.requested += count;
        nodes_evaluated_ = false;
    }

    /// Returns how many of the substeps (of dt, s) requested since the last call were done, and counts their time. They
    /// are fewer where the list has expired; find_pairs_if_displaced is due then.
    std::int64_t take_done(double dt);

    /// Step 7. Requests the report early, so that one synchronisation serves several readbacks.
    void request_report();

    /// Report of the step; synchronises. NumericalError when a contact is deeper than its law allows, or a body's
    /// position is not finite; `time` (s) is for that message.
    RigidReport report(double time);

    /// Output at present.
    RigidCensus           census();
    std::vector<BodyRow>  named_bodies();
    std::vector<JointRow> joints() const;
    void                  begin_mean();
    io::BodyFields        fields() const;
    void                  add_rocks(world::TerrainBins& bins) const { solver::add_rocks(state_, bins); }

    /// Records of the pairs that touched in the last step.
    std::vector<world::ContactRecord> contacts() const;

    /// Counts listed pairs, those of them that touch, and listed nodes; synchronises.
    ContactCount count_contacts();

    /// m, centre of a named body.
    Vec3<double> place(std::size_t body) const;

    /// s, integral over time since the run began of the share of a named body's weight that its contacts carried.
    double carried(std::size_t body) const;

    /// N s, impulse of a named body's contacts since the run began.
    Vec3<double> contact_impulse(std::size_t body) const;

    /// Saves the state to a checkpoint, or loads it into bodies of the same scene; call between two steps. Does not
    /// change later results. Contact energies are available again after the next substep.
    void transfer(StateFile& file);

private:
    bool renew_pairs(double dt, UnheldRows unheld);

    /// Number of substeps in dt (s), as the last one was.
    double substeps_in(double dt) const { return substep_ > 0 ? dt / substep_ : 1; }

    MotionBound bound(double speed) const
    {
        return {speed, commands_.heaviest * state_.gravity.norm() + prescribed_acceleration_};
    }

    BodyState<Exec>   state_;
    BodyCommands      commands_;
    PairLists<Exec>   lists_;
    BodyReports<Exec> reports_;
    NamedMeans<Exec>  means_;
    SleepSettings     sleep_;
    double            substep_         = 0;     ///< s, duration of the last substep
    bool              moved_in_sand_   = false; ///< whether bodies were last listed for substeps with sand
    bool              nodes_evaluated_ = false; ///< whether the list's nodes were evaluated where the bodies are now
    double            prescribed_acceleration_; ///< m/s2, bound on what prescribed forces cause

    std::optional<PrescribedMotions<Exec>> motions_; ///< only if some phase prescribes a motion
    std::optional<BodyJoints<Exec>>        joints_;  ///< only in a scene with joints
};

} // namespace tread::solver
