#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "harness.hpp"
#include "io/bed_file.hpp"
#include "temporary_directory.hpp"
#include "world/saved_bed.hpp"

// Beds of rocks settled in one scene and loaded by another.
namespace
{

using namespace tread;

template<class Exec>
class Beds : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Beds, test::Backends, test::BackendNames);

constexpr double rock_diameter = 0.06, gravity = 9.81;

const std::string stones = R"(
[[material]]
name    = "rock"
model   = "elastic"
density = 2700.0
young   = 1.0e6
poisson = 0.25
[[contact]]
between     = ["rock", "rock"]
friction    = 0.6
restitution = 0.3
[[contact]]
between     = ["rock", "wall"]
friction    = 0.6
restitution = 0.3
[[shape]]
name      = "clast"
generate  = { kind = "rock", seed = 3, aspect = 0.7, sphericity = 0.9, nodes = 162, variants = 2 }
sdf_cells = 24
[[rocks]]
shape    = "clast"
material = "rock"
)";

/// A dozen rocks that fall on each other in the open and settle as a heap.
const std::string heap_text = R"(
title = "heap"
[domain]
size    = [0.6, 0.6, 0.5]
gravity = [0.0, 0.0, -9.81]
)" + stones + R"(
count     = 12
diameter  = 0.06
placement = "rain"
region    = { box = [[0.22, 0.22, 0.0], [0.38, 0.38, 0.5]] }
[[phase]]
name     = "settle"
damping  = 0.3
duration = 3.0
)";

/// The same heap, with a ball that hangs above it and comes first in all lists.
std::string other_text(const std::string& bed)
{
    return R"(
title = "other"
[domain]
size    = [0.7, 0.6, 0.6]
gravity = [0.0, 0.0, -9.81]
)" + stones +
           fmt::format("from = \"{}\"", bed) + R"(
[[shape]]
name     = "ball"
generate = { kind = "sphere", nodes = 42 }
sdf_cells = 16
[[body]]
name     = "ball"
shape    = "ball"
material = "rock"
diameter = 0.05
mass     = 1.0
position = [0.3, 0.3, 0.55]
[[phase]]
name     = "rest"
hold     = ["ball"]
duration = 2.0
)";
}

struct Stillness
{
    double kinetic; ///< J, largest
    double slump;   ///< m, largest displacement of a rock
};

template<class Exec>
Stillness watch(const Exec& exec, const scene::Scene& scene, const world::World& world)
{
    test::Experiment<Exec> experiment(exec, scene, world);
    const auto             start = experiment.simulation().body_fields().position;
    Stillness              found{0, 0};
    int                    steps = 0;
    experiment.run(
        [&](double)
        {
            if (++steps % 10 != 0) { return; }
            found.kinetic = std::max(found.kinetic, experiment.simulation().census().rigid.kinetic);
        });
    const auto end = experiment.simulation().body_fields().position;
    for (std::size_t i = 0; i < start.size(); i += 3)
    {
        found.slump =
            std::max(found.slump, std::hypot(end[i] - start[i], end[i + 1] - start[i + 1], end[i + 2] - start[i + 2]));
    }
    return found;
}

/// Kinetic energy <= 1e-8 m g R, and displacement of at most 1e-2 R in 2 s. Friction holds the heap: rocks without
/// their contact history slide until the tangential springs are loaded again.
TYPED_TEST(Beds, SavedHeapStaysAtRestInAnotherScene)
{
    const test::TemporaryDirectory folder;
    const std::string              path = folder.path("bed.h5");
    test::Experiment<TypeParam>    settling(this->exec(), heap_text);
    settling.run();
    auto&             simulation = settling.simulation();
    const io::BedFile saved =
        make_bed(settling.scene(), settling.world(), simulation.body_fields(), simulation.contacts());
    io::write_bed(path, saved);

    const scene::Scene scene = test::load_text(other_text(path));
    world::World       world = world::build_world(scene);
    ASSERT_EQ(world.bodies.size(), saved.size() + 1);
    ASSERT_EQ(world.contacts.size(), saved.contacts.stiffness.size());
    EXPECT_GE(world.contacts.size(), saved.size()) << "every rock lies on something";
    for (std::size_t rock = 0; rock < saved.size(); ++rock)
    {
        EXPECT_EQ(world.bodies.position[rock + 1], Vec3<double>(saved.position.data() + 3 * rock));
        EXPECT_EQ(world.bodies.scale[rock + 1], saved.scale[rock]);
    }

    const double scale = static_cast<double>(saved.size()) * 2700 * std::acos(-1.0) / 6 * std::pow(rock_diameter, 3) *
                         gravity * 0.5 * rock_diameter; // J, m g R of all rocks
    const Stillness kept = watch(this->exec(), scene, world);
    world.contacts.clear();
    const Stillness forgot = watch(this->exec(), scene, world);
    test::report("KE / (m g R) of a saved bed, largest in 2 s", kept.kinetic / scale, 0, 1e-8, "rest");
    test::report("slump / R of a saved bed in 2 s", kept.slump / (0.5 * rock_diameter), 0, 1e-2, "rest");
    test::report("KE / (m g R) without the contacts", forgot.kinetic / scale, 0, 0, "must be over that with them");
    EXPECT_LE(kept.kinetic / scale, 1e-8);
    EXPECT_LE(kept.slump / (0.5 * rock_diameter), 1e-2);
    EXPECT_GT(forgot.kinetic, 10 * kept.kinetic);
}

} // namespace
