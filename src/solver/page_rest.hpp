#pragma once

#include <cstdint>
#include <vector>

#include "backend/vector.hpp"

namespace tread::solver
{

/// Which pages of sand may sleep.
struct RestRule
{
    double page_edge; ///< m
    double distance;  ///< m, of what sleeps from every body
    double speed;     ///< m/s that what sleeps was not over
    double rest;      ///< s for which it was not
};

/// A page with points that does not sleep.
struct AwakePage
{
    std::uint64_t key;
    double        speed; ///< m/s, the largest since the last look
    double        quiet; ///< s, for which speeds were not over the rule's
};

/// A body's bounding sphere, m.
struct BodyReach
{
    Vec3<double> centre;
    double       radius;
};

/// What there is to choose from. Keys ascend. A page to which points have come since it fell asleep is in both lists.
struct RestState
{
    std::vector<AwakePage>     awake;
    std::vector<std::uint64_t> asleep;
    std::vector<std::uint64_t> pressed; ///< sleeping pages whose load has changed
    std::vector<BodyReach>     bodies;
};

/// Pages around a moving one that stay awake, in pages.
inline constexpr int moving_ring = 2;

/// The pages that sleep from now on, keys ascending. A page wakes when a body is nearer than the rule's distance, when
/// one within moving_ring of it moves, and when its load, or that of a page beside it, has changed. It falls asleep
/// when it and all within moving_ring + 1 have been at rest for long enough and every body is two pages further off
/// than it has to be: what wakes does so in slices that last a while.
std::vector<std::uint64_t> choose_asleep(const RestRule& rule, const RestState& state);

} // namespace tread::solver
