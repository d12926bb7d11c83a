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
    double distance;  ///< m, distance of sleeping pages from named bodies
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

/// A body that keeps the sand around it awake, m.
struct BodyReach
{
    Vec3<double> centre;
    double       wakes; ///< sand that is nearer to the centre wakes
    double       rests; ///< sand that is farther from it may fall asleep; at least `wakes`
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

/// Chooses the pages that sleep from now on, keys ascending. A page wakes when a body is nearer than the distance at
/// which it wakes sand, when a page within moving_ring moves, or when its load or that of an adjacent page has changed.
/// It falls asleep when it and all pages within moving_ring + 1 have been at rest for long enough, beyond the distance
/// at which bodies let sand rest: that is farther, so that pages wake in slices that last a while.
std::vector<std::uint64_t> choose_asleep(const RestRule& rule, const RestState& state);

/// Chooses those of the pages `asleep`, keys ascending, that stay so beside these bodies: if one wakes a page, all
/// pages wake that no body lets rest.
std::vector<std::uint64_t> stay_asleep(const RestRule& rule, const std::vector<std::uint64_t>& asleep,
                                       const std::vector<BodyReach>& bodies);

} // namespace tread::solver
