#pragma once

#include <cstdint>

#include "kernels/dem/motion/outside.hpp"

// Subcycling: bodies whose contacts are too stiff for a substep take it in parts, with all bodies that they may touch.
// Pairs of a stiff body are evaluated in each part. All other pairs, and sand, are evaluated in the first part for the
// whole substep: what they push in it is given to a subcycled body at once (an impulse multiple-time-step method:
// Tuckerman, Berne and Martyna, J. Chem. Phys. 97, 1990, 1992). So both sides of a pair get the same impulse.
namespace tread::dem
{

/// Marks of the bodies and pairs that are subcycled, and the present part of the substep.
struct Subcycle
{
    static constexpr bool divides = true;

    const std::int32_t* pair  = nullptr; ///< of each pair: 1 if one of its bodies is stiff
    const std::int32_t* body  = nullptr; ///< of each body: 1 if one of its pairs is marked
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

    /// Factor of a force on body b that is constant in the substep, in this part.
    TREAD_HD double weight(std::int64_t b) const { return body[b] == 0 ? 1 : part == 0 ? parts : 0; }
    /// Likewise of the response of pair p.
    TREAD_HD double weight(std::int64_t b, std::int64_t p) const { return pair[p] != 0 ? 1 : weight(b); }
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
    TREAD_HD static constexpr double weight(std::int64_t) { return 1; }
    TREAD_HD static constexpr double weight(std::int64_t, std::int64_t) { return 1; }
};

/// Calls run with the Subcycle, or with WholeSubstep where it has one part.
template<class Run>
void by_cycle(const Subcycle& cycle, const Run& run)
{
    if (cycle.parts > 1) { run(cycle); }
    else { run(WholeSubstep{}); }
}

} // namespace tread::dem
