#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "shape/distance/mesh_distance.hpp"
#include "shape/generators/generators.hpp"
#include "shape/solids/mass_properties.hpp"
#include "shape/surface_nodes.hpp"
#include "shape/template.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using scene::GrouserShape;
using scene::WheelGenerator;

WheelGenerator builtin_wheel(const std::string& name)
{
    return std::get<WheelGenerator>(find_shape(scene::Scene{}, name).source);
}

double drum(const WheelGenerator& g, double y)
{
    const double edge = 2 * y / g.width;
    return g.radius - (g.grousers > 0 ? g.grouser_height : 0) - g.crown * edge * edge;
}

/// Range of radii in which the wheel without its grousers is hollow at y.
std::pair<double, double> hollow(const WheelGenerator& g, double y)
{
    const double away = std::abs(y), edge = 0.5 * g.width;
    const bool   flange = g.rim_height > 0 && away > edge - g.rim_thickness;
    const double outer  = flange ? drum(g, edge) - g.wall_thickness - g.rim_height : drum(g, y) - g.wall_thickness;
    if (g.hub_radius > 0 && away < 0.5 * g.web_thickness) { return {outer, outer}; }
    return {away < 0.5 * g.hub_width ? g.hub_radius : 0, outer};
}

double sweep(const WheelGenerator& g, double y)
{
    const double edge = std::abs(2 * y / g.width), ends = g.grouser_sweep_deg * test::pi / 180;
    return g.grouser_shape == GrouserShape::chevron ? ends * edge : ends * edge * edge;
}

/// Area of the section at y: the profile of revolution, and a slab per grouser less the drum's segment under it.
double section(const WheelGenerator& g, double y)
{
    const auto [low, high] = hollow(g, y);
    const double d         = drum(g, y);
    double       area      = test::pi * (d * d - high * high + low * low);
    if (g.grousers == 0) { return area; }
    const double half = 0.5 * g.grouser_width, tip = d + g.grouser_height;
    const double under = half * std::sqrt(d * d - half * half) + d * d * std::asin(half / d);
    return area + g.grousers * (2 * half * std::sqrt(tip * tip - half * half) - under);
}

/// Cavalieri's integral of the sections, piece by piece. Midpoint rule: exact to (piece/400)^2 of the crown's part.
double expected_volume(const WheelGenerator& g)
{
    const double        edge = 0.5 * g.width;
    std::vector<double> stops{0, 0.5 * g.web_thickness, 0.5 * g.hub_width, edge - g.rim_thickness, edge};
    std::sort(stops.begin(), stops.end());
    double volume = 0;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i)
    {
        constexpr int steps = 200;
        const double  step  = (stops[i + 1] - stops[i]) / steps;
        for (int s = 0; s < steps; ++s) { volume += 2 * step * section(g, stops[i] + (s + 0.5) * step); }
    }
    return volume;
}

bool is_inside(const WheelGenerator& g, const Eigen::Vector3d& point)
{
    if (std::abs(point.y()) > 0.5 * g.width) { return false; }
    const double radius    = std::hypot(point.x(), point.z());
    const auto [low, high] = hollow(g, point.y());
    const double d         = drum(g, point.y());
    if (radius <= d) { return radius < low || radius > high; }
    if (g.grousers == 0) { return false; }
    const double angle = std::atan2(point.x(), point.z()) - sweep(g, point.y());
    const double off   = std::remainder(angle, 2 * test::pi / g.grousers);
    const double half = 0.5 * g.grouser_width, tip = d + g.grouser_height;
    return std::abs(radius * std::sin(off)) < half && radius * std::cos(off) < std::sqrt(tip * tip - half * half);
}

/// Random parameters within the valid ranges, with walls and grousers of 1.5 % of the radius or more.
WheelGenerator random_wheel(Random& random)
{
    WheelGenerator g;
    g.radius         = random.uniform(0.05, 0.5);
    g.width          = g.radius * random.uniform(0.3, 2.5);
    g.grousers       = static_cast<int>(random.uniform(0, 50));
    g.grouser_height = g.radius * random.uniform(0.015, 0.15);
    g.crown          = random.uniform() < 0.5 ? 0 : g.radius * random.uniform(0.01, 0.2);
    const double end = drum(g, 0.5 * g.width);
    g.wall_thickness = random.uniform(0.015 * g.radius, 0.3 * end);
    g.grouser_width  = random.uniform(0.015 * g.radius, 0.3 * 2 * test::pi * end / std::max(g.grousers, 6));
    g.grouser_shape  = static_cast<GrouserShape>(static_cast<int>(random.uniform(0, 3)));
    if (g.grouser_shape != GrouserShape::straight)
    {
        g.grouser_sweep_deg = std::copysign(random.uniform(0.1, 40), random.uniform() - 0.5);
    }
    if (random.uniform() < 0.5)
    {
        g.hub_radius    = g.radius * random.uniform(0.1, 0.4);
        g.hub_width     = g.width * random.uniform(0.3, 1);
        g.web_thickness = g.hub_width * random.uniform(0.1, 0.8);
    }
    if (random.uniform() < 0.5)
    {
        g.rim_height    = (end - g.wall_thickness - g.hub_radius) * random.uniform(0.1, 0.9);
        g.rim_thickness = (g.width - g.web_thickness) * random.uniform(0.1, 0.4);
    }
    return g;
}

/// Longest side over the height on it, of the worst triangle.
double worst_aspect(const TriangleMesh& mesh)
{
    double worst = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        double longest = 0;
        for (std::size_t c = 0; c < 3; ++c)
        {
            longest = std::max(longest, (corner(mesh, t, c) - corner(mesh, t, (c + 1) % 3)).squaredNorm());
        }
        worst = std::max(worst, longest / area_vector(mesh, t).norm());
    }
    return worst;
}

double largest_radius(const TriangleMesh& mesh)
{
    double largest = 0;
    for (const auto& vertex : mesh.vertices) { largest = std::max(largest, std::hypot(vertex.x(), vertex.z())); }
    return largest;
}

/// Chords of 2 degrees remove (2 pi/180)^2/6 = 0.02 % of a disc and as much of a wall; a hub of 60 corners loses 0.2 %
/// of its own part; a crown's chords 1/600 of its height on a radius twenty times that.
constexpr double volume_tolerance = 2.5e-3;

TEST(Wheel, IsClosedStoutAndOfItsSectionsVolumeForAnyParameters)
{
    Random random(20240611);
    double worst_volume = 0, stretched = 0, centre = 0;
    for (int i = 0; i < 200; ++i)
    {
        const WheelGenerator g    = random_wheel(random);
        const TriangleMesh   mesh = wheel_mesh(g, "wheel");
        ASSERT_NO_THROW(require_watertight(mesh, "wheel " + std::to_string(i)));
        const MassProperties mass = mass_properties(mesh);
        worst_volume              = std::max(worst_volume, std::abs(mass.volume / expected_volume(g) - 1));
        stretched                 = std::max(stretched, worst_aspect(mesh));
        // A single grouser is out of balance, but no wheel is off centre along its axle.
        const double off_centre = g.grousers == 1 ? std::abs(mass.centre.y()) : mass.centre.norm();
        centre                  = std::max(centre, off_centre / g.radius);
        ASSERT_NEAR(largest_radius(mesh), g.radius, 1e-14);
        ASSERT_DOUBLE_EQ(bounds(mesh).extent().y(), g.width);
    }
    std::printf(
        "200 wheels: volume off by at most %.2g (tolerance %.2g), triangles at most %.1f as long as high (15)\n",
        worst_volume, volume_tolerance, stretched);
    EXPECT_LT(worst_volume, volume_tolerance);
    EXPECT_LT(stretched, 15);
    // Symmetric in exact arithmetic; rounding of sums of 1e5 terms.
    EXPECT_LT(centre, 1e-11);
}

TEST(Wheel, HasItsInsideWhereTheParametersSay)
{
    Random random(7);
    int    tried = 0;
    for (int i = 0; i < 12; ++i)
    {
        const WheelGenerator g      = random_wheel(random);
        const MeshDistance   wheel  = prepare_distance(wheel_mesh(g, "wheel"));
        const auto           within = [&](double most) { return random.uniform(-most, most); };
        for (int k = 0; k < 800; ++k)
        {
            const Eigen::Vector3d point(within(g.radius), within(0.55 * g.width), within(g.radius));
            const double          distance = signed_distance(wheel, point);
            // Chords of 2 degrees leave an error of 0.015 % of the radius, those of the steepest crown, of a fifth,
            // 1/2000.
            if (std::abs(distance) < 1e-3 * g.radius) { continue; }
            ++tried;
            ASSERT_EQ(distance < 0, is_inside(g, point)) << "wheel " << i << ", point " << point.transpose();
        }
    }
    EXPECT_GT(tried, 9000);
}

TEST(Wheel, BuiltinsAreWatertightWithTheVolumeOfTheirSections)
{
    for (const std::string& name : builtin_shape_names())
    {
        const WheelGenerator g    = builtin_wheel(name);
        const TriangleMesh   mesh = wheel_mesh(g, name);
        ASSERT_NO_THROW(require_watertight(mesh, name));
        const double expected = expected_volume(g);
        const double measured = mass_properties(mesh).volume;
        std::printf("%s: %zu triangles, volume measured %.6g m3, expected %.6g, tolerance %.2g; aspect %.1f\n",
                    name.c_str(), mesh.triangles.size(), measured, expected, volume_tolerance, worst_aspect(mesh));
        EXPECT_NEAR(measured, expected, volume_tolerance * expected);
        EXPECT_LT(mass_properties(mesh).centre.norm(), 1e-12);
    }
}

TEST(Wheel, BuiltinsReadBackFromTheirFiles)
{
    for (const std::string& name : builtin_shape_names())
    {
        const std::string  path = (std::filesystem::path(::testing::TempDir()) / (name + ".stl")).string();
        const TriangleMesh mesh = wheel_mesh(builtin_wheel(name), name);
        write_stl(mesh, path);
        const TriangleMesh read = read_mesh(path, 1);
        ASSERT_NO_THROW(require_watertight(read, name));
        EXPECT_EQ(read.triangles.size(), mesh.triangles.size());
        // Single precision of corners, 6e-8 of the radius, on walls of a 25th of it.
        const double volume = mass_properties(mesh).volume;
        EXPECT_NEAR(mass_properties(read).volume, volume, 1e-5 * volume);
        std::filesystem::remove(path);
    }
}

TEST(Wheel, PerseveranceIsThatOfThePaper)
{
    const WheelGenerator g = builtin_wheel("perseverance");
    EXPECT_EQ(g.grousers, 48);
    EXPECT_EQ(g.radius, 0.26);
    // 0.0058 m3 as given with two digits in the paper.
    EXPECT_NEAR(mass_properties(wheel_mesh(g, "wheel")).volume, 0.0058, 0.01 * 0.0058);
}

/// Number of times that a circle about the axle enters the wheel.
int entries(const MeshDistance& wheel, double radius, double y)
{
    constexpr int steps  = 7200;
    int           count  = 0;
    const auto    inside = [&](int step)
    {
        const double angle = 2 * test::pi * (step + 0.5) / steps;
        return signed_distance(wheel, {radius * std::sin(angle), y, radius * std::cos(angle)}) < 0;
    };
    for (int step = 0; step < steps; ++step) { count += !inside(step) && inside(step + 1) ? 1 : 0; }
    return count;
}

TEST(Wheel, HasItsGrousersAndIsOpenInside)
{
    const WheelGenerator g     = builtin_wheel("perseverance");
    const MeshDistance   wheel = prepare_distance(wheel_mesh(g, "wheel"));
    const double         inner = drum(g, 0) - g.wall_thickness;
    for (const double y : {-0.16, 0.0, 0.1})
    {
        EXPECT_EQ(entries(wheel, g.radius - 0.5 * g.grouser_height, y), 48);
        EXPECT_EQ(entries(wheel, 1.001 * g.radius, y), 0);
        EXPECT_EQ(entries(wheel, inner - 1e-4, y), 0);
        EXPECT_LT(signed_distance(wheel, {0, y, drum(g, 0) - 0.5 * g.wall_thickness}), 0);
    }
    // On the axle the nearest wall is the inner one; its chords of 1.7 degrees lie 0.01 % inside.
    EXPECT_NEAR(signed_distance(wheel, {0, 0, 0}), inner, 2e-4 * g.radius);
    EXPECT_GT(signed_distance(wheel, {0, 0, 0}), 0);
}

TEST(Wheel, PositiveSweepPutsTheEndsAheadWhenRollingForwards)
{
    WheelGenerator g;
    g.grouser_shape           = GrouserShape::chevron;
    g.grouser_sweep_deg       = 2;
    const double       radius = g.radius - 0.5 * g.grouser_height, angle = 2 * test::pi / 180;
    const MeshDistance wheel = prepare_distance(wheel_mesh(g, "wheel"));
    // Rolling to +x turns the top (+z) towards +x. At the top a grouser's middle is at x = 0 and its ends are ahead.
    const Eigen::Vector3d ahead(radius * std::sin(angle), 0.499 * g.width, radius * std::cos(angle));
    const Eigen::Vector3d behind(-ahead.x(), ahead.y(), ahead.z());
    EXPECT_LT(signed_distance(wheel, {0, 0, radius}), 0);
    EXPECT_LT(signed_distance(wheel, ahead), 0);
    EXPECT_GT(signed_distance(wheel, behind), 0);
}

TEST(Wheel, MayHaveNoGrousers)
{
    const TriangleMesh mesh = wheel_mesh({0.2, 0.1, 0.02, 0, 0.01, 0.01}, "drum");
    EXPECT_NO_THROW(require_watertight(mesh, "drum"));
    const double expected = test::pi * (0.2 * 0.2 - 0.18 * 0.18) * 0.1;
    // Chords of 2 degrees: the regular 180-gon has 1 - (2 pi/180)^2/6 = 0.9998 of the circle.
    EXPECT_NEAR(mass_properties(mesh).volume, expected * (1 - std::pow(test::pi / 90, 2) / 6), 1e-6 * expected);
}

TEST(Wheel, TakesNoTwistFromGrousersThatItDoesNotHave)
{
    WheelGenerator g;
    g.grousers              = 0;
    const TriangleMesh even = wheel_mesh(g, "drum");
    g.grouser_shape         = GrouserShape::chevron;
    g.grouser_sweep_deg     = 50;
    EXPECT_EQ(wheel_mesh(g, "drum").vertices, even.vertices);
}

TEST(FullSizeWheel, NodesShareTheAreaEvenlyAndStandOnTheGrousersTips)
{
    for (const std::string& name : builtin_shape_names())
    {
        const WheelGenerator g       = builtin_wheel(name);
        const TriangleMesh   mesh    = wheel_mesh(g, name);
        const double         spacing = g.radius / 32;
        const SurfaceNodes   nodes   = resample(mesh, spacing);
        double               sum = 0, least = 1e30, most = 0;
        std::map<int, int>   on_tips;
        for (std::size_t i = 0; i < nodes.areas.size(); ++i)
        {
            sum += nodes.areas[i];
            least                    = std::min(least, nodes.areas[i]);
            most                     = std::max(most, nodes.areas[i]);
            const Eigen::Vector3d& p = nodes.positions[i];
            if (std::hypot(p.x(), p.z()) < drum(g, p.y()) + 0.95 * g.grouser_height) { continue; }
            const double angle = std::atan2(p.x(), p.z()) - sweep(g, p.y());
            const int    tip   = static_cast<int>(std::lround(angle / (2 * test::pi) * g.grousers));
            ++on_tips[(tip + g.grousers) % g.grousers];
        }
        const double mean   = sum / static_cast<double>(nodes.areas.size());
        int          fewest = 1000000;
        for (const auto& [tip, count] : on_tips) { fewest = std::min(fewest, count); }
        std::printf("%s: %zu nodes, spacing %.2f of the asked, areas %.2f to %.2f of the mean, at least %d on a tip\n",
                    name.c_str(), nodes.areas.size(), nodes.spacing / spacing, least / mean, most / mean, fewest);
        EXPECT_NEAR(sum, surface_area(mesh), 1e-11 * sum);
        EXPECT_NEAR(nodes.spacing, spacing, 0.25 * spacing);
        EXPECT_GT(least, 0.1 * mean);
        EXPECT_LT(most, 4 * mean);
        // Thinning leaves neighbours on an edge at most 1.7 spacings apart.
        EXPECT_EQ(on_tips.size(), static_cast<std::size_t>(g.grousers));
        EXPECT_GE(fewest, static_cast<int>(g.width / (1.7 * spacing)));
    }
}

} // namespace
} // namespace tread::shape
