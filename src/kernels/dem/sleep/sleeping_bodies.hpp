#pragma once

#include <memory>

#include "backend/array.hpp"
#include "kernels/dem/contact/patch_kern.hpp"
#include "kernels/dem/contact/rolling_kern.hpp"
#include "kernels/dem/motion/shared.hpp"

// Bodies that sleep: they are held at rest, and pairs of two of them, or of one and a wall, are kept apart from the
// list of the substeps (sleep.hpp).
namespace tread::dem
{

/// Thresholds for the sleep of bodies.
struct BodyRestRule
{
    double       speed; ///< m/s; no point of a body at rest goes further than speed * rest in a time `rest`
    double       rest;  ///< s, time at rest before a body may sleep, and window over which loads are averaged
    double       load;  ///< change of the mean load that wakes a body, over the load that it carries
    std::int64_t first; ///< first body that may sleep
};

/// Watch over the motion of awake bodies: how long each has stayed near a place. Arrays by body.
struct RestWatch
{
    Vec3<double>* position;    ///< m, of the place
    Quat*         orientation; ///< likewise
    double*       quiet;       ///< s, for which the body has stayed near it
    std::int32_t* moves; ///< 1: it left the place before in less than BodyRestRule::rest, and may not have stopped

    /// Begins anew at the present place of body b, which has rested for `rested` (s).
    TREAD_HD void begin(const BodiesView& bodies, std::int64_t b, double rested) const
    {
        position[b]    = bodies.position[b];
        orientation[b] = bodies.orientation[b];
        quiet[b]       = rested;
        moves[b]       = 0;
    }
};

/// Load on a sleeping body. Forces in N, torques in N m about its centre of mass.
struct SleepWatch
{
    ContactWrench held;            ///< sum of its contacts with sleeping bodies, walls and sleeping sand, constant
    Vec3<double>  rest_force;      ///< reference: mean force of all contacts in the first whole window of its sleep
    Vec3<double>  rest_torque;     ///< likewise
    Vec3<double>  change_force;    ///< change of the mean force from the reference in the last window
    Vec3<double>  change_torque;   ///< likewise
    Vec3<double>  impulse;         ///< N s, of all contacts in this window, `held` only up to when it last changed
    Vec3<double>  angular_impulse; ///< N m s, likewise
    double        limit;           ///< N, change of the mean force that wakes it
    double        windows;         ///< windows since it, or sand on it, fell asleep; 3 for more
};

/// Response of a pair of sleepers.
struct HeldContact
{
    Vec3<double> force;     ///< N, on the first body
    Vec3<double> torque_a;  ///< N m, on the first body about its centre of mass
    Vec3<double> torque_b;  ///< N m, on the second body about its centre of mass
    double       stiffness; ///< N/m
    double       energy;    ///< J, elastic, including the springs of the patch
};

struct SleepingPairsView
{
    std::int64_t         count;
    const std::uint64_t* key; ///< ascending
    Patch*               patch;
    Rolling*             rolling; ///< null without rolling friction
    Vec3<double>*        place;   ///< as Patches::place; zero for a pair of one patch
    const HeldContact*   contact;
    const std::int32_t*  first; ///< [bodies + 1], as in PairsView
    const std::int32_t*  by_second;
    const std::int32_t*  second;
};

/// Pairs of sleepers with their records.
template<class Exec>
struct SleepingPairs
{
    explicit SleepingPairs(const Exec& exec)
        : key(exec, "sleeping pair keys")
        , patch(exec, "sleeping pair patches")
        , rolling(exec, "sleeping pair rolling moments")
        , place(exec, "sleeping patch places")
        , contact(exec, "sleeping contacts")
        , first(exec, "sleeping pairs of first body")
        , by_second(exec, "sleeping pairs by second body")
        , second(exec, "sleeping pairs of second body")
    {
    }

    SleepingPairsView view()
    {
        return {key.size(),   key.data(),     patch.data(), rolling.size() > 0 ? rolling.data() : nullptr,
                place.data(), contact.data(), first.data(), by_second.data(),
                second.data()};
    }

    Array<Exec, std::uint64_t> key;
    Array<Exec, Patch>         patch;
    Array<Exec, Rolling>       rolling;
    Array<Exec, Vec3<double>>  place;
    Array<Exec, HeldContact>   contact;
    Array<Exec, std::int32_t>  first;
    Array<Exec, std::int32_t>  by_second;
    Array<Exec, std::int32_t>  second;
};

/// Number of contacts beyond a body that wakes within which sleepers wake, too: a blow passes through several bodies
/// before the next look.
inline constexpr int waking_rings = 2; // assumed

/// Marks of bodies at a look. Of the marks that ranks have for one body, the largest holds.
enum SleepMark : std::int32_t
{
    mark_tired      = -1, ///< falls asleep
    mark_none       = 0,
    mark_wakes_calm = 1, ///< wakes alone and at rest, with the sand around it
    mark_wakes      = 2, ///< to 2 + waking_rings: by distance in contacts
};

/// Sand that a body may touch.
enum SandBed : std::int32_t
{
    bed_none   = 0,
    bed_awake  = 1, ///< all of it; several ranks may differ about bed_none, each of its own points
    bed_asleep = 2, ///< some of it
};

/// Times of the substeps so far, s.
struct SleepClock
{
    double look   = 0; ///< since the last look
    double window = 0; ///< since the window of mean loads began
    double held   = 0; ///< since SleepWatch::held last changed, or the window began
    double weight = 0; ///< kg s, mass of the sleepers times time, since the last report
    double slept  = 0; ///< s, summed over the sleepers, since the run began
    double lived  = 0; ///< since the run began
};

/// What several ranks do together for the sleep of bodies, so that all holders of a body decide alike. Collective.
template<class Exec>
class RanksOfSleepers
{
public:
    virtual ~RanksOfSleepers() = default;

    /// Bodies that this rank shares with others, and its shares.
    virtual SharedView shared() = 0;

    virtual void exchange_marks()    = 0;
    virtual void exchange_wrenches() = 0;

    /// Sums numbers over ranks, in rank order.
    virtual void add(double* values, int count) const = 0;
};

/// Data of the sleep of bodies; all arrays are empty where no body may sleep. Flags are in BodiesView::asleep.
template<class Exec>
struct SleepingBodies
{
    explicit SleepingBodies(const Exec& exec)
        : position(exec, "body positions at rest")
        , orientation(exec, "body orientations at rest")
        , quiet(exec, "body times at rest")
        , moves(exec, "moving bodies")
        , mark(exec, "body sleep marks")
        , watch(exec, "loads of sleeping bodies")
        , sand(exec, "sleeping sand on bodies")
        , bed(exec, "beds of bodies")
        , next_bed(exec, "next beds of bodies")
        , loaded(exec, "bodies that sand has loaded")
        , moved(exec, "bodies of substeps")
        , pairs(exec)
    {
    }

    bool         wanted = false; ///< whether bodies may sleep
    bool         strewn = false; ///< whether sand may sleep beside them
    bool         wakes  = false; ///< whether bodies near moving ones wake when the next list is found
    bool         change = false; ///< whether some body fell asleep or woke since the last list
    bool         woken  = false; ///< whether some body in sleeping sand woke since sand last followed
    BodyRestRule rule{};
    SleepClock   clock;
    double       here   = 0; ///< number of this rank's sleepers
    double       count  = 0; ///< likewise of all ranks
    double       mass   = 0; ///< kg, of all of them
    double       energy = 0; ///< J, elastic, of this rank's pairs of sleepers

    std::unique_ptr<RanksOfSleepers<Exec>> ranks; ///< null on one rank

    Array<Exec, Vec3<double>> position;    ///< RestWatch::position
    Array<Exec, Quat>         orientation; ///< RestWatch::orientation
    Array<Exec, double>       quiet;       ///< RestWatch::quiet
    Array<Exec, std::int32_t> moves;       ///< RestWatch::moves

    Array<Exec, std::int32_t>  mark;     ///< SleepMark of each body
    Array<Exec, SleepWatch>    watch;    ///< of each body
    Array<Exec, ContactWrench> sand;     ///< wrench of sleeping sand on each body; empty if none sleeps beside bodies
    Array<Exec, std::int32_t>  bed;      ///< SandBed of each body; empty if no sand sleeps beside bodies
    Array<Exec, std::int32_t>  next_bed; ///< likewise, for follow_beds
    Array<Exec, std::int32_t>  loaded;   ///< likewise, for renew_watches
    Array<Exec, std::int32_t>  moved;    ///< bodies that the substeps compute: awake ones, and sleepers that they touch
    SleepingPairs<Exec>        pairs;

    RestWatch rest_watch() { return {position.data(), orientation.data(), quiet.data(), moves.data()}; }

    /// Records that substeps have taken `time` (s).
    void pass(double time)
    {
        clock.look += time;
        clock.window += time;
        clock.held += time;
        clock.weight += time * mass;
        clock.slept += time * count;
        clock.lived += time;
    }

    /// Bodies that this rank shares with others.
    SharedView shared() const { return ranks ? ranks->shared() : SharedView{}; }

    /// Sums a struct of doubles over ranks.
    template<class Sums>
    void add_ranks(Sums& sums) const
    {
        static_assert(sizeof(Sums) % sizeof(double) == 0);
        if (ranks) { ranks->add(reinterpret_cast<double*>(&sums), sizeof(Sums) / sizeof(double)); }
    }

    /// Calls f(array) for each array by row that a body takes along when it changes ranks.
    template<class F>
    void for_each_state(F f)
    {
        f(position);
        f(orientation);
        f(quiet);
        f(moves);
        f(mark);
        f(watch);
        if (strewn) { f(bed); }
    }

    /// Makes room for what sand does to each body; nothing yet.
    void resize_sand(std::int64_t rows)
    {
        const auto at_zero = [rows](auto&... arrays) { ((arrays.resize(rows), arrays.fill_zero()), ...); };
        if (strewn) { at_zero(sand, next_bed, loaded); }
    }

    /// List of the bodies that substeps compute; null: all.
    const std::int32_t* list() const { return wanted ? moved.data() : nullptr; }
    std::int64_t        listed(std::int64_t bodies) const { return wanted ? moved.size() : bodies; }
};

} // namespace tread::dem
