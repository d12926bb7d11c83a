#pragma once

#include <utility>

#include "backend/async_readback.hpp"
#include "decomp/decomposition.hpp"
#include "kernels/contact/sleeping_contacts.hpp"
#include "kernels/contact/substeps.hpp"
#include "solver/ranks/body_numbers.hpp"
#include "solver/sand/sand_sleep.hpp"
#include "solver/touch_change.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// Numbers of bodies and points that contacts may refer to.
struct ContactPartners
{
    std::size_t bodies;
    std::size_t points; ///< awake points of this rank: places in memory
    std::size_t ids;    ///< points of the scene
    std::size_t materials;
};

/// The present list of pairs of bodies.
struct BodyList
{
    std::int64_t      version; ///< another one for each list
    dem::ListedPlaces places;  ///< nothing where no list is kept
};

/// The steps until find_candidates is called next.
struct CandidateSpan
{
    double time;       ///< s
    double speed;      ///< m/s: no point or body is faster now, nor will exceed twice that
    double sand_speed; ///< m/s: no point is faster now
};

/// Bytes of a contact that sleeps, and of its copy while contacts are merged.
inline constexpr std::int64_t sleeping_contact_bytes =
    2 * (sizeof(std::uint64_t) + sizeof(contact::Tangential) + sizeof(contact::HeldSand) + sizeof(std::int32_t));

/// Contact of the sand with the bodies of a scene, on one backend.
template<class Exec, class Real>
class SandBodyCoupling
{
public:
    SandBodyCoupling(const Exec& exec, const scene::Scene& scene, const world::World& world,
                     const dem::TemplateView* templates, dem::PairTable pairs,
                     decomp::Decomposition<Exec>* decomposition = nullptr);

    /// Collective, on several ranks: sends the contact records of migrated points after them. `migrated_out`: ids by
    /// destination rank, ascending.
    void send_records_after(const std::vector<std::vector<std::uint32_t>>& migrated_out);

    /// Step 3. Finds candidates for the next steps if the last ones may have expired: if something has moved in memory
    /// (`version`: layout version of points and bodies), or if the skin is used up: by points and bodies, or by points
    /// alone while the list of pairs of the search bounds the bodies.
    void find_candidates(const mpm::PointsView<Real>& points, const mpm::PagesView& pages,
                         const dem::BodiesView& bodies, const BodyList& list, std::int64_t version,
                         const CandidateSpan& next);

    /// Has the next find_candidates find them anew, as where other pairs touch from now on.
    void forget_candidates() { version_ = 0; }

    /// Adds the elastic energy (J) of this rank's contacts, as of the last substep, to that of their pair of materials:
    /// [sides x sides], smaller index first. `material`: of each body.
    void add_contact_energies(const BodyMaterials& material, std::size_t sides, std::vector<double>& energies) const;

    /// Overlaps of the pairs that begin to touch; call after find_candidates. `material`: of each body. Collective.
    NewTouch new_touch(const dem::BodiesView& bodies, const BodyMaterials& material, const TouchChange& change);

    /// Gives touched bodies their rows after others have come within a step. `row`: of each row before, the present
    /// one.
    void follow_rows(const Array<Exec, std::int32_t>& row, const dem::BodiesView& bodies)
    {
        contact::follow_rows(exec_, contact_, row, bodies);
    }

    /// Updates the contacts with the changes of their points in the last step, unless find_candidates has just done
    /// so.
    void begin_step(const mpm::PointsView<Real>& points);

    /// Computes forces on bodies, and the motion of the private points over a substep. `exec`: tag of the substeps.
    void substep(const Exec& exec, const dem::BodiesView& bodies, double dt);

    /// Wrenches of the last substep.
    dem::OutsideWrenches wrenches() const { return contact_.wrenches(); }

    /// Whether a single launch for all substeps of a step is worthwhile.
    bool worth_one_launch(const dem::BodyStep<Exec>& step) { return contact::worth_one_launch(exec_, contact_, step); }

    /// Runs `count` substeps in a single launch, contacts of bodies and their motion included.
    void run_substeps(dem::BodyStep<Exec> step, std::int64_t count);

    /// Converts impulses to the points' contact force.
    void finish_step(const mpm::PointsView<Real>& points, double dt);

    /// Measures the last substep over all ranks; synchronises.
    void measure();

    /// Requests the measurement early, so that one synchronisation serves several readbacks.
    void request_measure();

    /// The last measurement (dissipated: since the one before it), of contacts that are awake.
    const contact::Summary& summary() const { return summary_; }

    /// J, elastic energy of all contacts, sleeping ones included, as of the last measurement.
    double energy() const { return summary_.energy + energy_asleep_; }

    /// J, what friction dissipated in contacts that fell asleep since the last call.
    double take_loss_at_rest() { return std::exchange(loss_at_rest_, 0.0); }

    /// Takes the contacts of sleeping sand and rocks from the steps and gives those of woken sand back. Updates what
    /// sleeping sand presses rocks with, `sleepers.sand`, and marks the rocks that it has begun to press,
    /// `sleepers.loaded`. Call before points are sorted. Collective.
    void follow_sleep(const SleepChange<Real>& change, const dem::BodiesView& bodies,
                      dem::SleepingBodies<Exec>& sleepers);

    /// Writes what this rank's sleeping sand presses each rock with, `sleepers.sand`. Collective.
    void sum_asleep(const dem::BodiesView& bodies, dem::SleepingBodies<Exec>& sleepers);

    /// Sends the contacts of sleeping points that have changed ranks. `migrated_out`: as of send_records_after.
    /// Collective.
    void send_sleeping_after(const std::vector<std::vector<std::uint32_t>>& migrated_out);

    /// Saves or loads the contacts that sleep, where sand may sleep beside rocks, after transfer(). Where the state is
    /// not exact, all wake. Collective.
    void transfer_sleep(StateFile& file, const dem::BodiesView& bodies, dem::SleepingBodies<Exec>& sleepers,
                        const ContactPartners& partners);

    /// Saves or loads contact records and candidates, after the sand and the bodies.
    void transfer(StateFile& file, const dem::BodiesView& bodies, const ContactPartners& partners);

private:
    bool any_near() const { return contact_.candidates.body.size() > 0; }

    std::vector<std::int32_t> touched_bodies() const;

    NewTouch own_new_touch(const dem::BodiesView& bodies, const BodyMaterials& material, const TouchChange& change);

    std::vector<contact::HistoryRecord> remembered();

    void transfer_records(StateFile& file, std::vector<contact::HistoryRecord>& records,
                          const ContactPartners& partners);
    void transfer_candidates(StateFile& file, const dem::BodiesView& bodies, const ContactPartners& partners);
    void transfer_slots(StateFile& file, const ContactPartners& partners);
    template<class Bound>
    void wake_records(StateFile& file, const Bound& are_keys);

    Exec                                  exec_;
    contact::PointContact<Exec>           contact_;
    contact::SleepingContacts<Exec>       asleep_;
    double                                loss_at_rest_  = 0; ///< J, of all ranks
    double                                energy_asleep_ = 0; ///< J, elastic, of sleeping contacts of all ranks
    contact::PointBodyLaw                 law_;
    double                                largest_radius_;
    double                                skin_;             ///< m
    double                                used_         = 0; ///< m, part of the skin that is used up since the search
    double                                used_by_sand_ = 0; ///< m, likewise, before the last span, by points alone
    double                                span_         = 0; ///< s, CandidateSpan::time of the last call
    std::int64_t                          list_         = 0; ///< BodyList::version at the search
    std::int64_t                          version_      = 0; ///< layout version at the search; 0 = none yet
    bool                                  begun_        = false; ///< the search has begun the step
    std::int64_t                          named_; ///< named bodies come first; their contacts are counted apart
    contact::Summary                      summary_ = contact::Summary::zero();
    AsyncReadback<Exec, contact::Summary> readback_;
    bool                                  requested_ = false; ///< the next summary was requested
    const Communicator*                   communicator_;      ///< null on one rank
};

} // namespace tread::solver
