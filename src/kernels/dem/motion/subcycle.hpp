#pragma once

#include <cstdint>

#include "kernels/dem/motion/outside.hpp"

// Subcycling: bodies whose contacts are too stiff for a substep take it in parts, with all bodies that they may touch
// (docs/theory.md#subcycles). Pairs of a stiff body are evaluated in each part. All other pairs, and sand, are evaluated
// in the first part, and push for the whole substep along the same line.
namespace tread::dem
{

/// How a body moves in a substep.
enum CycleMark : std::int32_t
{
    cycle_whole  = 0, ///< at once
    cycle_beside = 1, ///< in parts, beside a stiff body: pushed in the first as if at once, then by what has changed
    cycle_stiff  = 2  ///< in parts, each by the forces of its beginning; sleepers and prescribed motions, too
};

/// What pushed a body in the first part of a substep.
struct FirstPush
{
    Vec3<double>  position; ///< m, of the body then
    ContactWrench contact;  ///< of pairs and sand
    Vec3<double>  wall;     ///< N, of walls, a part of it
};

/// Marks of what is subcycled, and the present part of the substep.
struct Subcycle
{
    static constexpr bool divides = true;

    const std::int32_t* pair  = nullptr; ///< of each pair: 1 if one of its bodies is stiff
    const std::int32_t* body  = nullptr; ///< CycleMark of each body
    FirstPush*          first = nullptr; ///< of each body that moves in parts
    std::int32_t        parts = 1;       ///< of a substep
    std::int32_t        part  = 0;       ///< present one

    /// Whether pair p is evaluated in this part.
    TREAD_HD bool is_due(std::int64_t p) const { return part == 0 || pair[p] != 0; }
    /// Whether body b moves in this part.
    TREAD_HD bool moves(std::int64_t b) const { return part == 0 || body[b] != cycle_whole; }
    /// Whether this part is the last of body b in the substep.
    TREAD_HD bool is_last(std::int64_t b) const { return body[b] == cycle_whole || part == parts - 1; }
    /// s, time that an evaluation of pair p stands for; `dt`: s, of the substep.
    TREAD_HD double span_of_pair(std::int64_t p, double dt) const { return pair[p] != 0 ? dt / parts : dt; }

    /// m, way of body b in the substep before this part; `position`: m, at present.
    TREAD_HD Vec3<double> way(std::int64_t b, const Vec3<double>& position) const
    {
        if (part == 0) { return Vec3<double>::Zero(); }
        return position - first[b].position;
    }
};

/// All bodies take a substep at once.
struct WholeSubstep
{
    static constexpr bool divides = false;

    TREAD_HD static constexpr bool   is_due(std::int64_t) { return true; }
    TREAD_HD static constexpr bool   moves(std::int64_t) { return true; }
    TREAD_HD static constexpr bool   is_last(std::int64_t) { return true; }
    TREAD_HD static constexpr double span_of_pair(std::int64_t, double dt) { return dt; }
};

/// Calls run with the Subcycle, or with WholeSubstep where it has one part.
template<class Run>
void by_cycle(const Subcycle& cycle, const Run& run)
{
    if (cycle.parts > 1) { run(cycle); }
    else { run(WholeSubstep{}); }
}

/// What pushes a body in a substep or a part of it.
struct Push
{
    ContactWrench contact; ///< of pairs and sand
    ContactWrench sand;    ///< a part of it
    Vec3<double>  wall;    ///< N, likewise
    double        weight;  ///< 1: its weight pushes as well; 0: it has done so
    double        lasts;   ///< s, for which all that pushes
    double        moves;   ///< s, for which the body moves then
};

/// Returns the push in a part of a substep of dt (s) on body b at `position` (m) from that of all its forces at present,
/// those that are not due as they were.
TREAD_HD Push push_in_part(const WholeSubstep&, std::int64_t, const Vec3<double>&, const Push& all) { return all; }

TREAD_HD Push push_in_part(const Subcycle& cycle, std::int64_t b, const Vec3<double>& position, const Push& all)
{
    Push               push = all;
    const std::int32_t mark = cycle.body[b];
    if (mark == cycle_whole) { return push; }
    push.moves = all.moves / cycle.parts;
    if (cycle.part == 0) { cycle.first[b] = {position, all.contact, all.wall}; }
    if (mark == cycle_stiff || cycle.part > 0) { push.lasts = push.moves; }
    if (mark == cycle_stiff || cycle.part == 0) { return push; }
    const FirstPush&   first = cycle.first[b];
    const Vec3<double> way   = position - first.position;
    push.contact.force -= first.contact.force;
    push.contact.torque -= first.contact.torque + first.contact.force.cross(way);
    push.sand = ContactWrench::zero();
    push.wall -= first.wall;
    push.weight = 0;
    return push;
}

} // namespace tread::dem
