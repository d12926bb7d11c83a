#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/dem/motion/outside.hpp"

// Bodies that several ranks move, each for its own contacts with them: all add up what all found, by rank, and so reach
// the same bits, and none has to tell another where a body went.
namespace tread::dem
{

/// What one rank's contacts do to a body.
struct WrenchShare
{
    ContactWrench outside; ///< from sand
    ContactWrench pairs;   ///< from bodies and walls
};

/// What a body's contacts will ask of the substep, of one rank's pairs (contact_limits.hpp). N/m.
struct StiffnessShare
{
    double touches;  ///< first touches of pairs that are apart; in a bed most of them will not come to be
    double approach; ///< what touches and what comes nearer
};

struct SharedView
{
    std::int64_t        count = 0;       ///< bodies that this rank moves with others
    const std::int32_t* body  = nullptr; ///< [count], ascending
    const std::int32_t* place = nullptr; ///< [bodies], in `body`; -1: no other rank moves it; null: there is one rank
    const std::int32_t* first = nullptr; ///< [count + 1], the shares of each body
    const std::int32_t* row   = nullptr; ///< in the two below, by rank

    WrenchShare*    wrench    = nullptr; ///< [rows], this rank's own first, [count]
    StiffnessShare* stiffness = nullptr; ///< likewise
    double*         speed     = nullptr; ///< likewise: m/s, of the fastest body near it

    TREAD_HD bool is_shared(std::int64_t b) const { return place != nullptr && place[b] >= 0; }
};

/// The shares of body[i] together.
TREAD_HD WrenchShare wrench_of(const SharedView& shared, std::int64_t i)
{
    WrenchShare sum{ContactWrench::zero(), ContactWrench::zero()};
    for (std::int32_t r = shared.first[i]; r < shared.first[i + 1]; ++r)
    {
        const WrenchShare& share = shared.wrench[shared.row[r]];
        sum                      = {sum.outside + share.outside, sum.pairs + share.pairs};
    }
    return sum;
}

/// The largest of the shares of body[i].
TREAD_HD double speed_of_all(const SharedView& shared, std::int64_t i)
{
    double largest = 0;
    for (std::int32_t r = shared.first[i]; r < shared.first[i + 1]; ++r)
    {
        largest = std::fmax(largest, shared.speed[shared.row[r]]);
    }
    return largest;
}

TREAD_HD StiffnessShare stiffness_of(const SharedView& shared, std::int64_t i)
{
    StiffnessShare sum{0, 0};
    for (std::int32_t r = shared.first[i]; r < shared.first[i + 1]; ++r)
    {
        const StiffnessShare& share = shared.stiffness[shared.row[r]];
        sum                         = {sum.touches + share.touches, sum.approach + share.approach};
    }
    return sum;
}

} // namespace tread::dem
