#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "rock_scenes.hpp"

// A trench of sand with rocks on it and in it, that may sleep.
namespace tread::test
{

inline constexpr double diameter       = 0.1;  ///< m, of the rocks
inline constexpr double settled        = 0.3;  ///< s, end of the damped phase
inline constexpr double sleep_distance = 0.1;  ///< m
inline constexpr double rock_speed     = 2e-3; ///< m/s

/// m, within which rocks may wake around a wheel of 0.1 m: sand is awake up to two pages of 0.2 m beyond the distance,
/// a page has a length, what moves on it wakes two pages around, and a rock at their end feels it.
inline constexpr double neighbourhood = 0.1 + sleep_distance + 5 * 0.2 + 0.5 * diameter;

inline const std::string strewn_sleep_text =
    fmt::format("[sleep]\ndistance = {}\nrock_speed = {}\n", sleep_distance, rock_speed);

/// For what has been disturbed: this coarse bed goes on trembling at 0.01 m/s.
inline const std::string trembling_sleep_text =
    fmt::format("[sleep]\ndistance = {}\nspeed = 0.03\nrock_speed = 0.01\n", sleep_distance);

/// A trench of sand of a length (m).
inline std::string strewn_ground(double length)
{
    return fmt::format(R"(
title = "strewn bed"
[domain]
size    = [{0}, 0.4, 1.6]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = 0.05
[numerics]
precision = "double"
[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region   = {{ box = [[0.0, 0.0, 0.0], [{0}, 0.4, 0.2]] }}
[[shape]]
name      = "clast"
generate  = {{ kind = "rock", seed = 3, aspect = 0.7, sphericity = 0.9, nodes = 42 }}
sdf_cells = 20
)",
                       length) +
           stone(1e7, 0.5, 0.5);
}

/// Rocks with their centres in a box from `low` to `high` (m) along x and z.
inline std::string some_rocks(int count, const std::array<double, 2>& low, const std::array<double, 2>& high)
{
    return fmt::format("[[rocks]]\nshape = \"clast\"\nmaterial = \"stone\"\ncount = {}\ndiameter = {}\n"
                       "placement = \"replace\"\nregion = {{ box = [[{}, 0.0, {}], [{}, 0.4, {}]] }}\n",
                       count, diameter, low[0], low[1], high[0], high[1]);
}

/// A bed with rocks half in the sand, and half as many under it.
inline std::string strewn_text(double length, int rocks)
{
    return strewn_ground(length) + some_rocks(rocks, {0.0, 0.14}, {length, 0.25}) +
           some_rocks(rocks / 2, {0.0, 0.02}, {length, 0.14});
}

inline const std::string short_bed = strewn_text(1.2, 4), long_bed = strewn_text(2.4, 8);

/// A rock that hangs 0.8 m above one end.
inline const std::string held_stone_text = fmt::format("[[body]]\nname = \"stone\"\nshape = \"clast\"\n"
                                                       "material = \"stone\"\ndiameter = {}\nmass = 1.4\n"
                                                       "position = [0.4, 0.2, 1.0]\n",
                                                       diameter);

/// A roller that hangs above one end, and phases.
inline const std::string strewn_roller_text = R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.2, wall_thickness = 0.04, grousers = 6 }
sdf_cells = 48
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 10.0
position = [0.4, 0.2, 0.9]
lock     = ["roll", "yaw"]
[[phase]]
name     = "settle"
damping  = 0.3
duration = 0.3
hold     = ["roller"]
[[phase]]
name     = "drive"
duration = 1.1
)";

/// Result of a run.
struct Bed
{
    std::vector<double>       bodies;         ///< m, positions at the end
    std::vector<double>       points;         ///< m
    std::vector<Vec3<double>> forces;         ///< N, of contacts on bodies
    std::int64_t              most_rocks = 0; ///< most sleeping rocks
    double                    energy     = 0; ///< unaccounted, over the largest exchange
    double                    momentum   = 0;
};

inline double largest_difference(const std::vector<double>& one, const std::vector<double>& other)
{
    double most = 0;
    for (std::size_t i = 0; i < one.size(); ++i) { most = std::max(most, std::abs(one[i] - other[i])); }
    return most;
}

/// Body with the largest x, or the smallest (`direction` -1); the first is none of the rocks.
inline std::size_t furthest_rock(const std::vector<double>& position, int direction)
{
    std::size_t found = 1;
    for (std::size_t b = 1; 3 * b < position.size(); ++b)
    {
        if (direction * (position[3 * b] - position[3 * found]) > 0) { found = b; }
    }
    return found;
}

inline double shift_of(std::size_t body, const std::vector<double>& from, const std::vector<double>& to)
{
    double squared = 0;
    for (std::size_t i = 3 * body; i < 3 * body + 3; ++i) { squared += (to[i] - from[i]) * (to[i] - from[i]); }
    return std::sqrt(squared);
}

template<class Exec>
class StrewnBed : public BackendTest<Exec>
{
protected:
    using Run = Experiment<Exec>;

    /// Calls watch(run, time) after every step and steer(time, commands) before it.
    template<class Watch, class Steer>
    Bed run(const std::string& text, Watch watch, Steer steer)
    {
        Run   experiment(this->exec(), text);
        auto& simulation = experiment.simulation();
        Bed   bed;
        experiment.steer([&](auto& commands) { steer(experiment.time(), commands); });
        experiment.run(
            [&](double time)
            {
                bed.most_rocks = std::max(bed.most_rocks, simulation.rocks_asleep());
                watch(experiment, time);
            });
        bed.bodies               = simulation.body_fields().position;
        bed.points               = simulation.point_fields().position;
        bed.forces               = forces(experiment);
        const solver::Census now = simulation.census();
        simulation.ledger().energy(now);
        simulation.ledger().balance(now);
        bed.energy   = std::abs(simulation.ledger().errors().energy);
        bed.momentum = simulation.ledger().errors().momentum;
        return bed;
    }

    template<class Watch>
    Bed run(const std::string& text, Watch watch)
    {
        return run(text, watch, [](double, auto&) {});
    }

    Bed run(const std::string& text)
    {
        return run(text, [](Run&, double) {});
    }

    /// Share of the points that sleep.
    static double share_asleep(Run& run)
    {
        auto& sand = run.simulation().sand();
        return static_cast<double>(sand.asleep()) / static_cast<double>(sand.count());
    }

    static bool all_asleep(Run& run)
    {
        const auto& bodies = run.world().bodies;
        const auto  rocks  = static_cast<std::int64_t>(bodies.size()) - bodies.named;
        return run.simulation().rocks_asleep() == rocks && share_asleep(run) == 1;
    }

    /// 1 = asleep, of each body.
    static std::vector<std::int32_t> sleepers(Run& run) { return copied(run, &dem::BodiesView::asleep); }

    /// N, of contacts on each body.
    static std::vector<Vec3<double>> forces(Run& run) { return copied(run, &dem::BodiesView::force); }

    /// m, least distances of a sleeping point from the bounding spheres of bodies that are awake; infinite if there is
    /// none.
    struct Nearest
    {
        double to_named;
        double to_rocks;

        void include(const Nearest& other)
        {
            to_named = std::min(to_named, other.to_named);
            to_rocks = std::min(to_rocks, other.to_rocks);
        }
    };

    static constexpr double  far_away = std::numeric_limits<double>::infinity();
    static constexpr Nearest nowhere{far_away, far_away};

    static Nearest nearest_sleeping_point(Run& run)
    {
        auto&                sand   = run.simulation().sand();
        const auto           x      = sand.positions(); // sleeping points come last
        const auto           asleep = sleepers(run);
        const io::BodyFields bodies = run.simulation().body_fields();
        Nearest              found  = nowhere;
        for (std::size_t b = 0; b < asleep.size(); ++b)
        {
            double& nearest = static_cast<std::int64_t>(b) < run.world().bodies.named ? found.to_named : found.to_rocks;
            if (asleep[b] != 0) { continue; }
            const auto&        form   = run.world().templates[static_cast<std::size_t>(bodies.shape[b])];
            const double       radius = form.bounding_radius * bodies.scale[b];
            const Vec3<double> centre(bodies.position.data() + 3 * b);
            for (auto i = static_cast<std::size_t>(sand.view().count); i < x.size(); ++i)
            {
                nearest = std::min(nearest, (x[i] - centre).norm() - radius);
            }
        }
        return found;
    }

    static void expect_awake_around(const Nearest& nearest)
    {
        report("nearest sleeping point to a named body (m)", nearest.to_named, 0.75 * sleep_distance, 0,
               "sand wakes before anything has moved a quarter of the distance");
        report("nearest sleeping point to a rock that is awake (m)", nearest.to_rocks, 0.025, 0,
               "half a cell: points have a radius of a quarter, and sleep a cell away");
        EXPECT_GE(nearest.to_named, 0.75 * sleep_distance);
        EXPECT_GE(nearest.to_rocks, 0.025);
    }

    /// Number of launches of steps and substeps so far.
    std::int64_t launches() const
    {
        std::int64_t sum = 0;
        for (const char* name :
             {"scatter", "gather", "update grid", "point-body forces", "move contact points", "copy contact points",
              "body contacts", "nodes found", "move bodies", "substeps of bodies", "substeps of sand and bodies"})
        {
            const auto found = this->counters.launches().find(name);
            if (found != this->counters.launches().end()) { sum += found->second; }
        }
        return sum;
    }

    static void expect_balanced(const std::string& what, const Bed& outcome, const Bed& awake)
    {
        report(what + ": energy unaccounted", outcome.energy, awake.energy, 2e-3,
               "as without sleep, since the ledger accounts for what falls asleep; impacts part by chance");
        report(what + ": momentum error", outcome.momentum, awake.momentum, 1e-6,
               "what holds sleepers is accounted for; fp64");
        EXPECT_LT(std::abs(outcome.energy - awake.energy), 2e-3);
        EXPECT_LT(outcome.momentum, std::max(1e-6, 2 * awake.momentum));
    }

private:
    template<class T>
    static std::vector<T> copied(Run& run, T* dem::BodiesView::*array)
    {
        const dem::BodiesView bodies = run.simulation().rigid().view();
        std::vector<T>        values(bodies.*array != nullptr ? static_cast<std::size_t>(bodies.count) : 0);
        copy_to_host(run.simulation().exec(), values.data(), bodies.*array, values.size() * sizeof(T));
        return values;
    }
};

} // namespace tread::test
