#pragma once

#include <algorithm>
#include <vector>

#include "kernels/dem/sleep/sleeping_bodies.hpp"
#include "kernels/mpm/pages/page_key.hpp"
#include "solver/sand/page_rest.hpp"

namespace tread::solver
{

/// How far bodies keep sand awake.
struct WakingRule
{
    double distance;  ///< m, from named bodies
    double page_edge; ///< m
    double rest;      ///< s, longest time between two looks
    double gravity;   ///< m/s2
};

/// Hysteresis in pages: extra distance from a named body beyond which sand falls asleep.
inline constexpr int reach_slack = 2;

/// Lists the bodies that keep sand awake: named ones, and rocks that are awake and not at rest. A rock that moves wakes
/// sand as far as it may come before the next look and a diameter beyond; another one, which only trembles, sand that
/// it may touch. Rocks at rest follow the sand. Without rocks that sleep, all bodies are as named ones. On several
/// ranks: those of this rank. `bounding_radii`: m, of each row's body. Synchronises.
template<class Exec>
std::vector<BodyReach> bodies_that_wake_sand(const Exec& exec, const dem::BodiesView& bodies,
                                             const dem::SleepingBodies<Exec>& sleepers,
                                             const std::vector<double>& bounding_radii, const WakingRule& rule)
{
    const auto                count = static_cast<std::size_t>(bodies.count);
    std::vector<Vec3<double>> centre(count), velocity(count);
    copy_to_host(exec, centre.data(), bodies.position, count * sizeof(Vec3<double>));
    copy_to_host(exec, velocity.data(), bodies.velocity, count * sizeof(Vec3<double>));
    std::vector<std::int32_t> asleep(bodies.asleep != nullptr ? count : 0);
    copy_to_host(exec, asleep.data(), bodies.asleep, asleep.size() * sizeof(std::int32_t));
    std::vector<std::int32_t> role(bodies.role != nullptr ? count : 0);
    copy_to_host(exec, role.data(), bodies.role, role.size() * sizeof(std::int32_t));
    const std::vector<double>       quiet = sleepers.quiet.to_host();
    std::vector<BodyReach>          reaches;
    const std::vector<std::int32_t> moves = sleepers.moves.to_host();
    for (std::size_t b = 0; b < count; ++b)
    {
        if (!role.empty() && role[b] != dem::role_owner) { continue; }
        const double radius = bounding_radii[b], far = radius + rule.distance;
        if (asleep.empty() || static_cast<std::int64_t>(b) < sleepers.rule.first)
        {
            reaches.push_back({centre[b], far, far + reach_slack * rule.page_edge});
        }
        else if (asleep[b] == 0 && quiet[b] < sleepers.rule.rest)
        {
            // What it hits may be twice as fast.
            const double travel = rule.rest * (2 * velocity[b].norm() + rule.gravity * rule.rest);
            const double rests  = std::min(far, radius + std::max(2 * radius, 0.5 * rule.page_edge) + travel);
            const double touch  = radius + rule.page_edge / (2 * mpm::page_edge);
            reaches.push_back({centre[b], moves[b] != 0 ? rests : std::min(rests, touch), rests});
        }
    }
    return reaches;
}

} // namespace tread::solver
