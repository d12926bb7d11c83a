#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mpi_calls.hpp"
#include "scene_parts.hpp"
#include "scene_text.hpp"
#include "solver/plan.hpp"
#include "solver/simulation.hpp"

// "Leave out what a given scene does not need", tested exactly: allocations and launches of each part of a scene are
// listed, and a scene uses exactly those of its parts. A single rank calls no MPI.
namespace
{

using namespace tread;
using namespace tread::test;

/// Allocations and launches in five steps from the start.
Part used_by(const std::string& text)
{
    const scene::Scene               scene = test::load_text(text);
    const world::World               world = world::build_world(scene);
    Counters                         counters;
    solver::Simulation<Cpu, float>   simulation(Cpu{&counters}, scene, world, solver::make_plan(scene, world));
    solver::StageClock               clock;
    std::vector<solver::BodyCommand> commands(scene.bodies.size());
    solver::TimeStep                 step;
    simulation.begin();
    for (int i = 0; i < 5; ++i)
    {
        step = solver::choose_step(scene.time, simulation.limits(), simulation.pace(), step.dt);
        simulation.command(commands, 0);
        simulation.step(step, 0, clock);
    }
    return used_of(counters);
}

std::string low_wheel()
{
    std::string text = test::roller_text;
    text.replace(text.find("[0.2, 0.2, 0.33]"), 16, "[0.2, 0.2, 0.305]");
    return text.replace(text.find("sdf_cells = 48"), 14, "sdf_cells = 20");
}

std::string without_terrain(std::string text)
{
    const auto begin = text.find("[[terrain]]");
    return text.erase(begin, text.find("\n[", begin + 1) - begin + 1);
}

std::string elastic_flip()
{
    std::string text = test::sand_text + "\n[numerics]\ntransfer = \"flip\"\n";
    text.replace(text.find("mohr-coulomb"), 12, "elastic");
    return text.erase(text.find("friction_angle_deg"), 25);
}

void expect_uses(const std::string& text, const Part& part)
{
    mpi_calls() = {};
    expect_equal(used_by(text), part);
    expect_equal(mpi_calls(), {}, "MPI call");
}

const std::string above  = test::rocks_text + "placement = \"grid\"\n",
                  within = test::rocks_text + "placement = \"replace\"\n";

TEST(LeftOut, ElasticSandWithFlip) { expect_uses(elastic_flip(), sand); }

TEST(LeftOut, SandAlone) { expect_uses(test::sand_text, soil); }

/// No sand sleeps without a distance; with one, these check and hold pages.
TEST(LeftOut, SandThatMaySleep)
{
    const Part sleep = {{"largest speeds of pages", "marks of held pages"},
                        {"keep largest speeds", "mark held pages", "write held pages"}};
    expect_uses(test::sand_text + "\n[sleep]\ndistance = 0.2\n", soil + sleep);
}

/// Rocks that may sleep are looked at; five steps after the start none does.
TEST(LeftOut, RocksThatMaySleep)
{
    const Part sleep = {{"bodies of substeps", "body orientations at rest", "body positions at rest",
                         "body sleep marks", "body times at rest", "loads of sleeping bodies", "moving bodies",
                         "sleeping bodies"},
                        {"bodies of substeps", "count sleep marks", "look at sleep", "time at rest"}};
    expect_uses(without_terrain(test::sand_text) + above + "[sleep]\nrock_speed = 1e-3\n",
                bodies + pairs + pairs_without_sand + sleep);
}

/// Rocks in sand that may sleep with them have room for what it presses them with, and for what it does.
TEST(LeftOut, SandAndRocksThatMaySleep)
{
    const std::string both = "[sleep]\ndistance = 0.2\n", rocks = both + "rock_speed = 1e-3\n";
    const Part without = used_by(test::sand_text + within + both), with = used_by(test::sand_text + within + rocks);
    const Part sleep = {{"bodies of substeps", "body sleep marks", "body times at rest", "loads of sleeping bodies",
                         "sleeping bodies", "sleeping sand on bodies", "beds of bodies", "next beds of bodies",
                         "bodies that sand has loaded", "body positions at rest", "body orientations at rest",
                         "moving bodies"},
                        {"bodies of substeps", "count sleep marks", "look at sleep", "time at rest"}};
    expect_equal(with, without + sleep);
}

std::string bolton(const std::string& more)
{
    std::string text = test::sand_text;
    return text.replace(text.find("\"mohr-coulomb\""), 14,
                        "\"bolton\"\nrelative_density = 0.8\nvoid_ratio_min = 0.5\nvoid_ratio_max = 0.9\n" + more);
}

TEST(LeftOut, SandThatKnowsItsDensity) { expect_uses(bolton(""), soil); }

TEST(LeftOut, SandWithASofteningLength) { expect_uses(bolton("softening_length = 0.1\n"), soil + mean_strain); }

TEST(LeftOut, RocksAlone)
{
    expect_uses(without_terrain(test::sand_text) + above, bodies + pairs + pairs_without_sand);
}

/// Each body has a factor; no launch is added.
TEST(LeftOut, RocksWhoseInertiaIsScaled)
{
    expect_uses(without_terrain(test::sand_text) + above + "[time]\nmass_scaling = 9.0\n",
                bodies + pairs + pairs_without_sand + Part{{"inertia factors of bodies"}, {}});
}

TEST(LeftOut, AWheelOnRocks)
{
    expect_uses(without_terrain(low_wheel()) + above, wheel + pairs + pairs_without_sand + pairs_of_a_large_body);
}

TEST(LeftOut, AWheelOnSand) { expect_uses(low_wheel(), soil + wheel + contact_with_sand); }

/// Motions add no launch.
TEST(LeftOut, AWheelWithAPrescribedMotion)
{
    const Part motions = {{"prescribed motions", "reaction impulses"}, {}};
    expect_uses(low_wheel() + "[[phase]]\nname = \"sink\"\nduration = 1.0\nmotion = [ { body = \"roller\", z = { "
                              "velocity = -0.1 } } ]\n",
                soil + wheel + contact_with_sand + motions);
}

TEST(LeftOut, RocksInSand) { expect_uses(test::sand_text + within, soil + bodies + pairs + contact_with_sand); }

TEST(LeftOut, AWheelOnSandWithRocks) { expect_uses(low_wheel() + within, soil + wheel + pairs + contact_with_sand); }

/// One list holds the pages around wheels and rocks alike. For a body without sand nearby only its own few pages are
/// checked.
TEST(LeftOut, BodiesFarFromSandHaveNoContactsWithIt)
{
    std::string high = low_wheel();
    high.replace(high.find("[0.2, 0.2, 0.305]"), 17, "[0.2, 0.2, 0.45]");
    const Part used = used_by(high);
    for (const char* name : {"private point position", "contact response", "contact wrench sums", "contact tangential"})
    {
        EXPECT_FALSE(used.arrays.count(name)) << name;
    }
    for (const char* name : {"write candidates", "copy contact points", "point-body forces", "recall contacts",
                             "move contact points", "give back impulses", "summarise contacts"})
    {
        EXPECT_FALSE(used.kernels.count(name)) << name;
    }
    EXPECT_TRUE(used.kernels.count("count contact pages"));
}

TEST(LeftOut, TrianglesAreThereForRaysAlone)
{
    const Part used = used_by(without_terrain(test::sand_text) + above + "[numerics]\nnarrow_phase = \"rays\"\n");
    for (const char* name :
         {"template boxes", "template triangles", "template node normals", "template ray lengths", "template rays"})
    {
        EXPECT_TRUE(used.arrays.count(name)) << name;
    }
}

} // namespace
