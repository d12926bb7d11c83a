#include <map>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/errors.hpp"

#include "run/estimate.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"

// Backend memory of a run: estimated in advance, and no more than the sand needs.
namespace
{

using namespace tread;
using namespace tread::run;
using test::load_text;

/// Memory used by the first steps of a scene, and the final state.
struct Trial
{
    std::int64_t                                     peak = 0; ///< bytes
    std::map<std::string, std::int64_t, std::less<>> bytes, launches;
    std::vector<Vec3<double>>                        positions;
};

template<class Real>
Trial first_steps(const scene::Scene& scene, Counters& counters, int count = 3)
{
    const world::World                     world = world::build_world(scene);
    solver::Simulation<Cpu, Real>          simulation(Cpu{&counters}, scene, world, solver::make_plan(scene, world));
    solver::StageClock                     clock;
    solver::TimeStep                       step;
    const std::vector<solver::BodyCommand> commands(scene.bodies.size());
    simulation.begin();
    for (int i = 0; i < count; ++i)
    {
        step = solver::choose_step(scene.time, simulation.limits(), simulation.pace(), step.dt);
        simulation.command(commands, 0);
        simulation.step(step, 0, clock);
    }
    return {counters.peak_bytes(), counters.bytes(), counters.launches(), simulation.sand().positions()};
}

std::string finer(std::string text) { return text.replace(text.find("0.05"), 4, "0.02"); }

template<class Real>
void expect_true_estimate(const std::string& text, const std::vector<std::string>& overrides = {})
{
    const scene::Scene scene = load_text(text, overrides);
    const world::World world = world::build_world(scene);
    Counters           counters;
    const double wanted = static_cast<double>(estimate(scene, world, solver::make_plan(scene, world)).memory_bytes);
    const double used   = static_cast<double>(first_steps<Real>(scene, counters).peak);
    std::cout << "[ memory   ] estimate over use: " << wanted / used << '\n';
    EXPECT_NEAR(wanted / used, 1, 0.1);
}

TEST(Memory, EstimateIsTrueWithinATenth)
{
    const std::string single = "numerics.precision=single", two = "numerics.precision=double",
                      apic = "numerics.transfer=apic";
    expect_true_estimate<float>(test::sand_text, {single});
    expect_true_estimate<float>(finer(test::sand_text), {single});
    expect_true_estimate<float>(finer(test::sand_text), {single, "terrain[0].points_per_cell=1"});
    expect_true_estimate<float>(test::sand_text, {single, "numerics.volume_strain=cell-average"});
    std::string nonlocal = test::sand_text;
    nonlocal.replace(nonlocal.find("\"mohr-coulomb\""), 14,
                     "\"bolton\"\nrelative_density = 0.8\nvoid_ratio_min = 0.5\nvoid_ratio_max = 0.9\n"
                     "softening_length = 0.1");
    expect_true_estimate<float>(nonlocal, {single});
    expect_true_estimate<double>(finer(test::sand_text), {two});
    expect_true_estimate<double>(finer(test::sand_text), {two, apic});
    expect_true_estimate<float>(finer(test::roller_text), {single});
}

TEST(Memory, AllRanksHaveTheBodiesAndAShareOfTheRest)
{
    const scene::Scene scene = load_text(test::sand_text + test::rocks_text + "placement = \"replace\"\n");
    const world::World world = world::build_world(scene);
    const Estimate     wants = estimate(scene, world, solver::make_plan(scene, world));
    EXPECT_GT(wants.copied_bytes, static_cast<std::int64_t>(sizeof(double) * 13 * world.bodies.size()));
    EXPECT_EQ(memory_of_rank(wants, 1), wants.memory_bytes);
    EXPECT_EQ(memory_of_rank(wants, 2), wants.copied_bytes + (wants.memory_bytes - wants.copied_bytes) / 2);
    EXPECT_NEAR(static_cast<double>(memory_of_rank(wants, 1 << 30)), static_cast<double>(wants.copied_bytes), 1);
}

TEST(Memory, EstimateHasRoomForAllSandToSleep)
{
    const scene::Scene scene =
        load_text(finer(test::sand_text) + "[sleep]\ndistance = 0.1\nspeed = 1.0\nrest = 1e-4\n");
    const world::World world = world::build_world(scene);
    Counters           counters;
    const double wanted = static_cast<double>(estimate(scene, world, solver::make_plan(scene, world)).memory_bytes);
    first_steps<float>(scene, counters, 40); // sleep is checked in steps that measure
    ASSERT_TRUE(counters.bytes().count("leaving points"));
    const double used = static_cast<double>(counters.peak_bytes());
    std::cout << "[ memory   ] estimate over use, all asleep: " << wanted / used << '\n';
    EXPECT_NEAR(wanted / used, 1, 0.1);
}

/// A heap of 1 m on a fixed floor, its low corner at (at, at, 0), in a domain of size x size x 1 m.
std::string pile(const std::string& at, const std::string& to, const std::string& size)
{
    return fmt::format(R"(
title = "pile"
[domain]
size    = [{2}, {2}, 1.0]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.0625
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region   = {{ box = [[{0}, {0}, 0.0], [{1}, {1}, 0.5]] }}
[[phase]]
name = "slump"
duration = 0.05
)",
                       at, to, size);
}

TEST(Memory, FollowsTheSandAndNotTheDomain)
{
    // Lengths that fp64 and whole pages represent exactly: 800.0 m is 3200 pages of 0.25 m.
    Counters    near_counters, far_counters;
    const Trial near = first_steps<float>(load_text(pile("1.0", "2.0", "3.0")), near_counters);
    const Trial far  = first_steps<float>(load_text(pile("801.0", "802.0", "1000.0")), far_counters);
    EXPECT_EQ(near.bytes, far.bytes);
    EXPECT_EQ(near.peak, far.peak);
    EXPECT_EQ(near.launches, far.launches);
    // 1.1e-13 m is the resolution of fp64 at 801 m: one rounding per step.
    ASSERT_EQ(near.positions.size(), far.positions.size());
    double farthest = 0;
    for (std::size_t i = 0; i < near.positions.size(); ++i)
    {
        farthest = std::max(farthest, (far.positions[i] - near.positions[i] - Vec3<double>(800, 800, 0)).norm());
    }
    std::cout << "[ memory   ] " << near.peak << " bytes in 3 m and in 1 km; places differ by " << farthest << " m\n";
    EXPECT_LT(farthest, 3 * 2e-13);
}

TEST(Memory, ASceneThatDoesNotFitSaysWhatItWants)
{
    Counters counters;
    counters.expect(5'000'000'000);
    counters.limit(1'000'000);
    try
    {
        first_steps<float>(load_text(finer(test::sand_text)), counters);
        FAIL();
    }
    catch (const EnvironmentError& error)
    {
        const std::string text = error.what();
        for (const char* part :
             {"out of host memory", "'point ", "wants", "is free", "the run holds", "5.00 GB in all"})
        {
            EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
        }
    }
    EXPECT_EQ(counters.current_bytes(), 0);
    EXPECT_NO_THROW(require_room("device", 100, 95));
    EXPECT_THROW(require_room("device", 100, 85), EnvironmentError);
}

} // namespace
