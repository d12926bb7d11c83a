#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/dem/motion/outside.hpp"

// Shared bodies: several ranks integrate them, each computing its own contacts with them. All ranks add the shares of
// all ranks in rank order and so reach the same bits; positions need not be exchanged.
namespace tread::dem
{

/// Contact wrench on a body from one rank's contacts.
struct WrenchShare
{
    ContactWrench outside; ///< from sand
    ContactWrench pairs;   ///< from bodies and walls
};

/// Expected stiffness of a body's contacts from one rank's pairs, which limits the substep (contact_limits.hpp). N/m.
struct StiffnessShare
{
    double touches;     ///< sum over first touches of separated pairs; in a bed most of them do not come about
    double first_touch; ///< largest of them
    double approach;    ///< sum over pairs in contact and pairs that approach

    /// Stiffness to expect. A body that is set in motion leaves the neighbours behind it, so that half of its first
    /// touches may come about together.
    TREAD_HD double most() const { return std::fmax(approach, std::fmax(first_touch, 0.5 * touches)); }
};

/// Speeds of a body and those near it.
struct NearSpeeds
{
    double fastest; ///< m/s, maximum of all
    double passing; ///< m/s, maximum of the others' points against the body; its own speed where one cannot go along
};

struct SharedView
{
    std::int64_t        count = 0;       ///< number of bodies that this rank integrates together with others
    const std::int32_t* body  = nullptr; ///< [count], ascending
    const std::int32_t* place = nullptr; ///< [bodies], index in `body`; -1: not shared; null: there is one rank
    const std::int32_t* first = nullptr; ///< [count + 1], first share of each body
    const std::int32_t* row   = nullptr; ///< row in the arrays below, by rank

    WrenchShare*    wrench    = nullptr; ///< [rows], this rank's own shares first: [count]
    StiffnessShare* stiffness = nullptr; ///< [rows], likewise
    NearSpeeds*     near      = nullptr; ///< [rows], likewise
    std::int32_t*   mark      = nullptr; ///< [rows], likewise: of the sleep of bodies

    TREAD_HD bool is_shared(std::int64_t b) const { return place != nullptr && place[b] >= 0; }
};

/// Sums the wrench shares of body[i] over ranks.
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

/// Maxima over ranks of the speed shares of body[i].
TREAD_HD NearSpeeds near_of_all(const SharedView& shared, std::int64_t i)
{
    NearSpeeds largest{0, 0};
    for (std::int32_t r = shared.first[i]; r < shared.first[i + 1]; ++r)
    {
        const NearSpeeds& share = shared.near[shared.row[r]];
        largest = {std::fmax(largest.fastest, share.fastest), std::fmax(largest.passing, share.passing)};
    }
    return largest;
}

/// Maximum over ranks of the marks of body[i].
TREAD_HD std::int32_t mark_of_all(const SharedView& shared, std::int64_t i)
{
    std::int32_t largest = shared.mark[shared.row[shared.first[i]]];
    for (std::int32_t r = shared.first[i] + 1; r < shared.first[i + 1]; ++r)
    {
        const std::int32_t mark = shared.mark[shared.row[r]];
        largest                 = mark > largest ? mark : largest;
    }
    return largest;
}

TREAD_HD StiffnessShare stiffness_of(const SharedView& shared, std::int64_t i)
{
    StiffnessShare sum{0, 0, 0};
    for (std::int32_t r = shared.first[i]; r < shared.first[i + 1]; ++r)
    {
        const StiffnessShare& share = shared.stiffness[shared.row[r]];
        sum                         = {sum.touches + share.touches, std::fmax(sum.first_touch, share.first_touch),
                                       sum.approach + share.approach};
    }
    return sum;
}

} // namespace tread::dem
