#pragma once

#include <cmath>

#include "kernels/dem/motion/move_impl.hpp"
#include "kernels/dem/pairs/displacement_kern.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

// Item functions of sleep.hpp: who falls asleep and wakes.
namespace tread::dem::sleeping
{

/// Calls visit(other) for the other side of every listed pair of body b; a wall is a number from `bodies` on.
template<class Visit>
TREAD_HD void each_neighbour(const PairsView& pairs, std::int64_t b, Visit visit)
{
    for (std::int32_t p = pairs.first[b]; p < pairs.first[b + 1]; ++p) { visit(second_of(pairs.key[p])); }
    for (std::int32_t i = pairs.second[b]; i < pairs.second[b + 1]; ++i)
    {
        visit(first_of(pairs.key[pairs.by_second[i]]));
    }
}

/// Watches whether an awake body has left its place. A speed would not do: a rock in sand trembles with it without
/// getting anywhere.
struct WatchRest
{
    BodiesView          bodies;
    const TemplateView* templates;
    BodyRestRule        rule;
    double              time; ///< s, since the last look
    RestWatch           watch;

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (bodies.is_asleep(b)) { return; }
        const double radius = bounding_radius(bodies, templates, b), near = rule.speed * rule.rest,
                     moved = displacement_since(bodies, b, watch.position[b], watch.orientation[b], radius);
        if (moved > near)
        {
            const bool is_moving = moved > 2 * near || watch.quiet[b] < rule.rest;
            watch.begin(bodies, b, 0);
            watch.moves[b] = is_moving ? 1 : 0;
            return;
        }
        watch.quiet[b] += time;
        if (watch.quiet[b] >= rule.rest) { watch.moves[b] = 0; }
    }
};

TREAD_HD bool is_moving(const BodiesView& bodies, const std::int32_t* moves, std::int64_t b)
{
    return !bodies.is_asleep(b) && moves[b] != 0;
}

/// Marks who falls asleep or wakes.
struct LookAtBody
{
    BodiesView          bodies;
    const TemplateView* templates;
    PairsView           pairs;
    BodyRestRule        rule;
    double              window; ///< s, of the window that ends now; 0: it goes on
    double              held;   ///< s, since SleepWatch::held last changed, or the window began
    RestWatch           rest;
    const std::int32_t* bed; ///< SandBed of each body; null if no sand sleeps beside bodies
    SleepWatch*         watch;
    std::int32_t*       mark;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool sleeps = bodies.is_asleep(b), may = b >= rule.first;
        mark[b] = mark_none;
        if (sleeps && wakes(b)) { mark[b] = mark_wakes; }
        if (may && !sleeps && is_tired(b)) { mark[b] = mark_tired; }
    }

private:
    /// Whether a body that something holds and all that it may touch have been at rest for long enough.
    TREAD_HD bool is_tired(std::int64_t b) const
    {
        bool rests = rest.quiet[b] >= rule.rest && bodies.stiffness[b] > 0;
        if (!rests) { return false; }
        each_neighbour(pairs, b,
                       [&](std::int64_t other)
                       {
                           const bool still = other >= bodies.count || bodies.is_asleep(other);
                           rests            = rests && (still || rest.quiet[other] >= rule.rest);
                       });
        return rests;
    }

    TREAD_HD bool wakes(std::int64_t b) const
    {
        const bool follows = bed != nullptr && bed[b] == bed_asleep;
        bool       found   = window > 0 && load_has_changed(b, watch[b]) && !follows;
        each_neighbour(pairs, b,
                       [&](std::int64_t other)
                       { found = found || (other < bodies.count && is_moving(bodies, rest.moves, other)); });
        return found;
    }

    /// Takes the mean load of the window that ends. The first whole one is the reference; a change that was there when
    /// sand fell asleep on the body stays.
    TREAD_HD bool load_has_changed(std::int64_t b, SleepWatch& load) const
    {
        const double       inverse = 1.0 / window;
        const Vec3<double> force   = inverse * (load.impulse + held * load.held.force),
                           torque  = inverse * (load.angular_impulse + held * load.held.torque);
        load.impulse               = Vec3<double>::Zero();
        load.angular_impulse       = Vec3<double>::Zero();
        load.windows               = std::fmin(load.windows + 1, 3.0);
        if (load.windows < 3)
        {
            load.rest_force  = force - load.change_force;
            load.rest_torque = torque - load.change_torque;
            return false;
        }
        load.change_force  = force - load.rest_force;
        load.change_torque = torque - load.rest_torque;
        const double arm   = bounding_radius(bodies, templates, b);
        return load.change_force.norm() > load.limit || load.change_torque.norm() > load.limit * arm;
    }
};

/// Writes whether a body of this rank wakes, may fall asleep, is awake (SleepCount).
struct CountMark
{
    BodiesView          bodies;
    std::int64_t        first; ///< BodyRestRule::first
    const std::int32_t* mark;
    double*             rows; ///< [bodies x 3]

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool counts = bodies.is_owned(b);
        rows[3 * b]       = counts && mark[b] > mark_none ? 1 : 0;
        rows[3 * b + 1]   = counts && mark[b] == mark_tired ? 1 : 0;
        rows[3 * b + 2]   = counts && b >= first && !bodies.is_asleep(b) ? 1 : 0;
    }
};

struct ShareMark
{
    SharedView          shared;
    const std::int32_t* mark;

    TREAD_HD void operator()(std::int64_t i) const { shared.mark[i] = mark[shared.body[i]]; }
};

struct TakeMark
{
    SharedView    shared;
    std::int32_t* mark;

    TREAD_HD void operator()(std::int64_t i) const { mark[shared.body[i]] = mark_of_all(shared, i); }
};

struct RenewWatch
{
    std::int32_t* loaded;
    SleepWatch*   watch;

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (loaded[b] != 0) { watch[b].windows = 0; }
        loaded[b] = 0;
    }
};

/// Marks a body that follows its bed.
struct FollowBed
{
    BodiesView          bodies;
    BodyRestRule        rule;
    const double*       quiet; ///< s, RestWatch::quiet
    const std::int32_t* next;
    std::int32_t*       bed;
    std::int32_t*       mark;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool sleeps = bodies.is_asleep(b), may = b >= rule.first;
        const bool wakes = sleeps && bed[b] == bed_asleep && next[b] != bed_asleep;
        const bool tired = may && !sleeps && next[b] == bed_asleep && quiet[b] >= rule.rest;
        bed[b]           = wakes ? bed_awake : next[b]; // points that still sleep are in no awake page
        mark[b]          = wakes ? mark_wakes_calm : tired ? mark_tired : mark_none;
    }
};

/// Marks sleepers near bodies that move; several threads may set the same mark.
struct MarkNear
{
    PairSearch          search;
    const std::int32_t* moves; ///< RestWatch::moves
    std::int32_t*       mark;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const PairSearch::Part part = PairSearch::part_of(i);
        if (!search.has_body(part)) { return; }
        if (part.part < PairSearch::cell_rows && !is_moving(search.bodies, moves, search.cell_body[part.place]))
        {
            return;
        }
        search(part, [&](std::uint64_t key) { meet(first_of(key), second_of(key)); });
    }

private:
    TREAD_HD void meet(std::int64_t a, std::int64_t b) const
    {
        const BodiesView& bodies = search.bodies;
        if (b >= bodies.count) { return; }
        if (bodies.is_asleep(a) && is_moving(bodies, moves, b)) { mark[a] = mark_wakes; }
        if (bodies.is_asleep(b) && is_moving(bodies, moves, a)) { mark[b] = mark_wakes; }
    }
};

/// Marks the neighbours, among sleepers, of bodies with the mark `level`.
struct WidenMarks
{
    BodiesView        bodies;
    SleepingPairsView pairs;
    std::int32_t      level;
    std::int32_t*     mark;

    TREAD_HD void operator()(std::int64_t b) const
    {
        if (!bodies.is_asleep(b) || mark[b] != mark_none) { return; }
        bool found = false;
        for (std::int32_t p = pairs.first[b]; p < pairs.first[b + 1]; ++p)
        {
            const std::int64_t other = second_of(pairs.key[p]);
            found                    = found || (other < bodies.count && mark[other] == level);
        }
        for (std::int32_t i = pairs.second[b]; i < pairs.second[b + 1]; ++i)
        {
            found = found || mark[first_of(pairs.key[pairs.by_second[i]])] == level;
        }
        if (found) { mark[b] = level + 1; }
    }
};

/// Numbers of bodies that wake.
struct Woken
{
    double bodies;
    double in_sand; ///< those around which sand that sleeps must wake, too
};

struct WakeBody
{
    BodiesView          bodies;
    BodyRestRule        rule;
    const std::int32_t* bed; ///< SandBed of each body; null if no sand sleeps beside bodies
    std::int32_t*       mark;
    RestWatch           watch;
    double*             woken; ///< Woken of each body

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool wakes = mark[b] > mark_none, calm = mark[b] == mark_wakes_calm, counts = wakes && bodies.is_owned(b);
        woken[2 * b]     = counts ? 1 : 0;
        woken[2 * b + 1] = counts && !calm && bed != nullptr && bed[b] == bed_asleep ? 1 : 0;
        if (wakes)
        {
            bodies.asleep[b] = 0;
            watch.begin(bodies, b, calm ? rule.rest : 0.0);
        }
        mark[b] = mark_none;
    }
};

} // namespace tread::dem::sleeping
