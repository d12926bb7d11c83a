#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"
#include "world/host_points.hpp"
#include "world/saved_bed.hpp"
#include "world/saved_sand.hpp"

// Rocks in sand, settled by one run and loaded by another.
namespace
{

using namespace tread;
using namespace tread::solver;
using test::load_text;

std::string loading(const std::string& path, const std::string& more = "")
{
    std::string text   = test::sand_text + test::rocks_text;
    const auto  region = text.find("region   = ");
    text.replace(region, text.find('\n', region) - region, fmt::format("from = \"{}\"", path));
    const auto count = text.find("count    = 8");
    return text.replace(count, std::string::npos, fmt::format("from = \"{}\"\n{}", path, more));
}

struct Rest
{
    double kinetic = 0; ///< J, largest
    double slump   = 0; ///< m, largest displacement of a rock or a point
};

class SavedSand : public ::testing::Test
{
protected:
    SavedSand()
        : scene(load_text(test::sand_text + test::rocks_text))
        , world(world::build_world(scene))
    {
        Simulation<Cpu, double> simulation(Cpu{&counters}, scene, world, make_plan(scene, world));
        simulation.begin();
        rest       = run(simulation, scene, 0.5, 0.3);
        bed        = world::make_bed(scene, world, simulation.body_fields(), simulation.contacts());
        bed.points = world::saved_points(Communicator(MPI_COMM_SELF), scene, world, simulation.point_fields());
        io::write_bed(path, bed);
    }

    static Rest run(Simulation<Cpu, double>& simulation, const scene::Scene& scene, double duration, double damping)
    {
        StageClock                clock;
        Rest                      rest;
        TimeStep                  step;
        double                    time   = 0;
        const io::PointFields     points = simulation.point_fields();
        const std::vector<double> bodies = simulation.body_fields().position;
        while (time < duration)
        {
            if (simulation.measured())
            {
                step = choose_step(scene.time, simulation.limits(), simulation.pace(), step.dt);
            }
            simulation.command({}, damping);
            step = simulation.step(step, time, clock);
            time += step.dt;
            if (!simulation.measured()) { continue; }
            const Census now = simulation.census();
            rest.kinetic     = std::max(rest.kinetic, now.sand.kinetic + now.rigid.kinetic);
        }
        const io::PointFields     later = simulation.point_fields();
        const std::vector<double> after = simulation.body_fields().position;
        std::vector<double>       begun(3 * (*std::max_element(points.id.begin(), points.id.end()) + 1));
        for (std::size_t i = 0; i < points.position.size(); ++i)
        {
            begun[3 * points.id[i / 3] + i % 3] = points.position[i];
        }
        for (std::size_t i = 0; i < later.position.size(); ++i)
        {
            rest.slump = std::max(rest.slump, std::abs(later.position[i] - begun[3 * later.id[i / 3] + i % 3]));
        }
        for (std::size_t i = 0; i < after.size(); ++i)
        {
            rest.slump = std::max(rest.slump, std::abs(after[i] - bodies[i]));
        }
        return rest;
    }

    std::string refusal(const std::string& text) const
    {
        try
        {
            world::build_world(load_text(text));
        }
        catch (const InputError& error)
        {
            return error.what();
        }
        return "accepted";
    }

    test::TemporaryDirectory folder;
    std::string              path = folder.path("bed.h5");
    scene::Scene             scene;
    world::World             world;
    Counters                 counters;
    io::BedFile              bed;
    Rest                     rest;
};

TEST_F(SavedSand, ComesBackAsItWas)
{
    const scene::Scene      other  = load_text(loading(path));
    const world::World      built  = world::build_world(other);
    const world::HostPoints loaded = world::make_points(other, built, built.sand.rows);
    ASSERT_EQ(loaded.size(), world.sand.size());
    ASSERT_EQ(built.bodies.size(), world.bodies.size());
    double worst = 0;
    for (std::size_t i = 0; i < loaded.size(); ++i)
    {
        EXPECT_EQ(loaded.position[i], Vec3<double>(bed.points.position.data() + 3 * i));
        EXPECT_EQ(loaded.mass[i], bed.points.mass[i]);
        EXPECT_EQ(loaded.volume[i], bed.points.volume[i]);
        for (int c = 0; c < 6; ++c)
        {
            worst =
                std::max(worst, std::abs(loaded.stress[i][c] - bed.points.stress[6 * i + static_cast<std::size_t>(c)]));
        }
    }
    EXPECT_EQ(worst, 0);
    EXPECT_EQ(loaded.plastic_shear, bed.points.plastic_shear);
    const auto sum = [](const std::vector<double>& values)
    { return std::accumulate(values.begin(), values.end(), 0.0); };
    const world::HostPoints points = world::make_points(scene, world, world.sand.rows);
    EXPECT_NEAR(sum(loaded.mass), sum(points.mass), 1e-9);
    EXPECT_NEAR(sum(loaded.volume) / sum(points.volume), 1, 0.01) << "the weight presses it by less";
}

/// The contact history of sand and bodies is not saved. Without it, a bed at rest moves by less than a thousandth of
/// its depth of 0.2 m, and far less than a newly created bed.
TEST_F(SavedSand, StaysAtRest)
{
    const scene::Scene      other = load_text(loading(path));
    const world::World      again = world::build_world(other);
    Simulation<Cpu, double> simulation(Cpu{&counters}, other, again, make_plan(other, again));
    simulation.begin();
    const Rest kept = run(simulation, other, 0.2, 0);
    std::cout << "loaded bed, 0.2 s without damping: kinetic energy at most " << kept.kinetic << " J, moved at most "
              << kept.slump
              << " m (tolerance 2e-4 m, a thousandth of its depth); the bed that was made: " << rest.kinetic << " J, "
              << rest.slump << " m\n";
    EXPECT_LT(kept.slump, 2e-4);
    EXPECT_LT(kept.kinetic, 0.1 * rest.kinetic);
}

TEST_F(SavedSand, MustFitTheScene)
{
    std::string coarse = loading(path);
    EXPECT_NE(refusal(coarse.replace(coarse.find("spacing = 0.05"), 14, "spacing = 0.04"))
                  .find("[grid] spacing is 0.04 in the scene and 0.05 in the bed"),
              std::string::npos);
    std::string soft = loading(path);
    EXPECT_NE(refusal(soft.replace(soft.find("young              = 1.0e6"), 26, "young              = 2.0e6"))
                  .find("young of material \"sand\""),
              std::string::npos);
    std::string small = loading(path);
    EXPECT_NE(refusal(small.replace(small.find("[0.4, 0.4, 0.6]"), 15, "[0.2, 0.4, 0.6]")).find("outside the domain"),
              std::string::npos);
    EXPECT_NE(refusal(loading(folder.path("none.h5"))).find("bed"), std::string::npos);
}

} // namespace
