#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "solver/simulation.hpp"

// Sand that leaves through an open wall remains in the ledger.
namespace
{

using namespace tread;
using namespace tread::solver;

std::string thrown_out()
{
    std::string text = test::sand_text;
    text.replace(
        text.find("gravity = [0.0, 0.0, -9.81]"), 27,
        "gravity = [0.0, 0.0, -9.81]\nwalls = { x = \"open\", y = \"open\", bottom = \"open\", top = \"open\" }");
    text.replace(text.find("material = \"sand\"\n"), 18, "material = \"sand\"\nvelocity = [5.0, 0.0, 0.0]\n");
    return text;
}

TEST(Leaving, CountsWhatHasLeft)
{
    const scene::Scene      scene = test::load_text(thrown_out());
    const world::World      world = world::build_world(scene);
    Counters                counters;
    Simulation<Cpu, double> simulation(Cpu{&counters}, scene, world, make_plan(scene, world));
    simulation.begin();
    const std::vector<Census> start{simulation.census()};
    StageClock                clock;
    TimeStep                  step;
    double                    time = 0;
    EXPECT_DOUBLE_EQ(simulation.pace().largest_speed, 5) << "the first step knows it";
    for (; time < 0.4; time += step.dt)
    {
        step = choose_step(scene.time, simulation.limits(), simulation.pace(), step.dt);
        step = simulation.step(step, time, clock);
    }
    const Census now = simulation.census();
    EXPECT_EQ(simulation.points(), 0) << "at 5 m/s 0.4 m and the margin of two cells take 0.1 s, and falling less";
    Ledger& ledger = simulation.ledger();
    ledger.energy(now);
    ledger.balance(now);
    std::cout << "[ ledger   ] mass " << ledger.errors().mass << ", momentum " << ledger.errors().momentum
              << ", energy " << ledger.errors().energy << '\n';
    EXPECT_LT(ledger.errors().mass, 1e-14);
    EXPECT_LT(ledger.errors().momentum, 1e-12);
    // Leaving sand takes along half a step of its weight's power: g dt / v, here 9.81 * 1e-3 / 5.
    EXPECT_LT(std::abs(ledger.errors().energy), 4e-3);
    EXPECT_NEAR(now.sand.mass, start.front().sand.mass, 1e-12 * now.sand.mass);
}

} // namespace
