#pragma once

#include <cstdint>
#include <vector>

#include "backend/vector.hpp"

namespace tread::solver
{

/// Thresholds for the sleep of pages.
struct RestRule
{
    double page_edge; ///< m
    double distance;  ///< m, least distance of sleeping pages from every body
    double speed;     ///< m/s, largest speed of points at rest
    double rest;      ///< s, time at rest before a page may sleep
};

/// An awake page with points.
struct AwakePage
{
    std::uint64_t key;
    double        speed; ///< m/s, largest since the last check
    double        quiet; ///< s, time since speeds last exceeded the threshold
};

/// Bounding sphere of a body that keeps sand awake, m.
struct BodyReach
{
    Vec3<double> centre;
    double       radius;
};

/// Input of choose_asleep. Keys ascend. A page that points have entered since it fell asleep is in both lists.
struct RestState
{
    std::vector<AwakePage>     awake;
    std::vector<std::uint64_t> asleep;
    std::vector<std::uint64_t> pressed; ///< sleeping pages whose load has changed
    std::vector<BodyReach>     bodies;
};

/// Distance in pages around a moving page within which pages stay awake.
inline constexpr int moving_ring = 2;

/// Chooses the pages that sleep from now on, keys ascending. A page wakes when a body is nearer than the threshold
/// distance, when a page within moving_ring moves, or when its load or that of an adjacent page has changed. It falls
/// asleep when it and all pages within moving_ring + 1 have been at rest for long enough and every body is two pages
/// beyond the threshold distance, so that pages wake in slices that last a while.
std::vector<std::uint64_t> choose_asleep(const RestRule& rule, const RestState& state);

/// Chooses those of the pages `asleep`, keys ascending, that stay so beside these bodies: if a page is nearer to one
/// than the threshold distance, those within two pages beyond it wake, too.
std::vector<std::uint64_t> stay_asleep(const RestRule& rule, const std::vector<std::uint64_t>& asleep,
                                       const std::vector<BodyReach>& bodies);

} // namespace tread::solver
