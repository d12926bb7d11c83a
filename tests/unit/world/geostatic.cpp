#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "kernels/mpm/laws/law_kern.hpp"
#include "scene_text.hpp"
#include "world/host_points.hpp"
#include "world/materials.hpp"

namespace
{

using namespace tread;
using namespace tread::world;
using test::load_text;

std::string layers(const std::string& lower_height, const std::string& velocity = "[0, 0, 0]")
{
    return R"(
[domain]
size    = [0.4, 0.2, 0.6]
gravity = [0.0, 0.0, -10.0]
[grid]
spacing = 0.05
[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.2
friction_angle_deg = 30.0
[[material]]
name    = "clay"
model   = "elastic"
density = 2000.0
young   = 1.0e6
poisson = 0.4
[[phase]]
name     = "rest"
duration = 0.01
[[terrain]]
material = "clay"
region   = { box = [[0, 0, 0], [0.4, 0.2, 0.2]] }
height   = ")" +
           lower_height + R"("
[[terrain]]
material = "sand"
region   = { box = [[0, 0, 0], [0.4, 0.2, 0.3]] }
floor    = ")" +
           lower_height + R"("
velocity = )" +
           velocity + "\n";
}

HostPoints points_of(const std::string& text)
{
    const auto  scene = load_text(text);
    const World world = build_world(scene);
    return make_points(scene, world, world.sand.rows);
}

/// Sand of 0.1 m over 0.2 m of clay: sigma_v from the weight above, and each material's own stress ratio: sand Ka = 1/3
/// over K0 = 1/4, clay K0 = 2/3. Exact on the lattice.
TEST(Geostatic, LayersOfTwoMaterials)
{
    const HostPoints points = points_of(layers("0.2"));
    double           worst  = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double z        = points.position[i][2];
        const bool   sand     = z > 0.2;
        const double vertical = sand ? 16000 * (0.3 - z) : 16000 * 0.1 + 20000 * (0.2 - z);
        const double ratio    = sand ? 1.0 / 3 : 2.0 / 3;
        worst                 = std::max(
                            {worst, std::abs(points.stress[i][2] + vertical), std::abs(points.stress[i][0] + ratio * vertical)});
    }
    std::cout << "two layers: worst error " << worst << " Pa of " << 5600 << ", tolerance 1e-8 Pa (rounding of sums)\n";
    EXPECT_LT(worst, 1e-8);
}

/// Moving sand is not at rest: the clay carries only itself, the sand nothing.
TEST(Geostatic, LeavesOutWhatMoves)
{
    const HostPoints points = points_of(layers("0.2", "[0, 0, -1]"));
    double           worst  = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const double z        = points.position[i][2];
        const double vertical = z > 0.2 ? 0 : 20000 * (0.2 - z);
        worst                 = std::max(worst, std::abs(points.stress[i][2] + vertical));
    }
    EXPECT_LT(worst, 1e-8);
}

/// The vertical force on the lowest layer of points, plus half of that layer, is the weight of sand and rocks. A rock
/// distributes its whole weight to columns; points above a rock's centre carry none of it, those below all. Hence the
/// sum over the lowest points of sigma_v times a point's plan area is all the weight above their centres, if all
/// columns have a point there.
TEST(Geostatic, CarriesTheRocks)
{
    const auto scene =
        load_text(test::sand_text + test::rocks_text, {"rocks[0].region.box=[[0, 0, 0.06], [0.4, 0.4, 0.2]]"});
    const World      world  = build_world(scene);
    const HostPoints points = make_points(scene, world, world.sand.rows);
    double           force = 0, weight = 0, lowest = 1;
    for (const auto& x : points.position) { lowest = std::min(lowest, x[2]); }
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const bool bottom = points.position[i][2] < lowest + 1e-9;
        weight += 9.81 * points.mass[i] * (bottom ? 0.5 : 1);
        if (bottom) { force -= points.stress[i][2] * 0.025 * 0.025; }
    }
    for (const double mass : world.bodies.mass) { weight += 9.81 * mass; }
    std::cout << "force at the bottom " << force << " N, weight " << weight << " N, tolerance 1e-9 of it\n";
    EXPECT_NEAR(force, weight, 1e-9 * weight);
}

/// Under the active stress a granular material is at its yield limit: slightly less lateral stress yields, slightly
/// more does not.
TEST(Geostatic, ActiveStressIsAtTheYieldLimit)
{
    const std::string models[] = {"mohr-coulomb", "drucker-prager\"\ndrucker_prager_fit = \"compression",
                                  "drucker-prager\"\ndrucker_prager_fit = \"extension",
                                  "drucker-prager\"\ndrucker_prager_fit = \"plane-strain"};
    for (const std::string& model : models)
    {
        std::string text = layers("0.2");
        text.replace(text.find("mohr-coulomb"), 12, model);
        text.replace(text.find("friction_angle_deg"), 0, "cohesion = 200.0\n");
        const scene::Scene scene    = load_text(text);
        const auto         material = law_parameters<double>(scene)[0];
        const double       vertical = 5000, horizontal = active_stress(scene.materials[0], vertical);
        const auto         shear_with = [&](double change)
        {
            const double       side = -horizontal * (1 + change);
            const Sym3<double> stress(side, side, -vertical, 0, 0, 0);
            const Mat3<double> still = Mat3<double>::Zero();
            return mpm::update_stress(material, stress, mpm::PlasticState<double>{}, still, 1.0).state.plastic_shear;
        };
        std::cout << model << ": active stress " << horizontal << " Pa under " << vertical << " Pa\n";
        EXPECT_EQ(shear_with(1e-9), 0);
        EXPECT_GT(shear_with(-1e-9), 0);
    }
}

} // namespace
