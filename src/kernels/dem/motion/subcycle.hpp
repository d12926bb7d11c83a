#pragma once

#include <cstdint>

#include "kernels/dem/motion/outside.hpp"

// Subcycling: bodies whose contacts are too stiff for a substep take it in parts, with all bodies that they may touch.
// Pairs of a stiff body are evaluated in each part. All other pairs, and sand, are evaluated in the first part, and
// push for the whole substep with the same force along the same line: so both sides of a pair get the same impulse and
// angular impulse, and what rests in equilibrium stays so (docs/theory.md#subcycles).
namespace tread::dem
{

/// Marks of the bodies and pairs that are subcycled, and the present part of the substep.
struct Subcycle
{
    static constexpr bool divides = true;

    const std::int32_t* pair  = nullptr; ///< of each pair: 1 if one of its bodies is stiff
    const std::int32_t* body  = nullptr; ///< of each body: 1 if one of its pairs is marked
    Vec3<double>*       start = nullptr; ///< m, position of each marked body when the substep began
    std::int32_t        parts = 1;       ///< of a substep
    std::int32_t        part  = 0;       ///< present one

    /// Whether pair p is evaluated in this part.
    TREAD_HD bool is_due(std::int64_t p) const { return part == 0 || pair[p] != 0; }
    /// Whether body b moves in this part.
    TREAD_HD bool moves(std::int64_t b) const { return part == 0 || body[b] != 0; }
    /// Whether this part is the last of body b in the substep.
    TREAD_HD bool is_last(std::int64_t b) const { return body[b] == 0 || part == parts - 1; }

    /// s, time that an evaluation of pair p stands for; `dt`: s, of the substep.
    TREAD_HD double span_of_pair(std::int64_t p, double dt) const { return pair[p] != 0 ? dt / parts : dt; }
    /// s, time that body b moves in this part.
    TREAD_HD double span_of_body(std::int64_t b, double dt) const { return body[b] != 0 ? dt / parts : dt; }

    /// Notes where body b is (m), before it moves.
    TREAD_HD void begin(std::int64_t b, const Vec3<double>& position) const
    {
        if (part == 0 && body[b] != 0) { start[b] = position; }
    }
    /// m, way of body b since the substep began; `position`: m, at present.
    TREAD_HD Vec3<double> way(std::int64_t b, const Vec3<double>& position) const
    {
        if (part == 0) { return Vec3<double>::Zero(); }
        return position - start[b];
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
    TREAD_HD static constexpr double span_of_body(std::int64_t, double dt) { return dt; }
    TREAD_HD static constexpr void   begin(std::int64_t, const Vec3<double>&) {}
};

/// Calls run with the Subcycle, or with WholeSubstep where it has one part.
template<class Run>
void by_cycle(const Subcycle& cycle, const Run& run)
{
    if (cycle.parts > 1) { run(cycle); }
    else { run(WholeSubstep{}); }
}

} // namespace tread::dem
