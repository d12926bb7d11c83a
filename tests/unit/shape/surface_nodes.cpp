#include "shape/surface_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "shape/mesh/half_edges.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using Eigen::Vector3d;

double total(const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.0); }

double nearest_distance(const SurfaceNodes& nodes, const Vector3d& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3d& node : nodes.positions) { least = std::min(least, (node - point).norm()); }
    return least;
}

void expect_parts_enclose(const SurfaceNodes& nodes)
{
    const std::size_t count = nodes.positions.size();
    ASSERT_EQ(nodes.areas.size(), count);
    ASSERT_EQ(nodes.part_centres.size(), (count + SurfaceNodes::part_size - 1) / SurfaceNodes::part_size);
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t c = i / SurfaceNodes::part_size;
        ASSERT_LE((nodes.positions[i] - nodes.part_centres[c]).norm(), nodes.part_radii[c] * (1 + 1e-12));
    }
}

TEST(SurfaceNodes, VerticesShareTheArea)
{
    const TriangleMesh mesh  = test::ellipsoid({1, 0.775, 0.55}, 642);
    const SurfaceNodes nodes = nodes_at_vertices(mesh);
    EXPECT_EQ(nodes.positions.size(), 642u);
    EXPECT_NEAR(total(nodes.areas), surface_area(mesh), 1e-12);
    EXPECT_DOUBLE_EQ(nodes.spacing, std::sqrt(total(nodes.areas) / 642));
    expect_parts_enclose(nodes);
}

/// Mean over runs of `size` nodes of the furthest from the middle of their box, in spacings.
double mean_radius(const SurfaceNodes& nodes, std::size_t size)
{
    std::vector<double> radii;
    for (std::size_t first = 0; first + size <= nodes.positions.size(); first += size)
    {
        Eigen::AlignedBox3d box;
        for (std::size_t i = first; i < first + size; ++i) { box.extend(nodes.positions[i]); }
        radii.push_back(0);
        for (std::size_t i = first; i < first + size; ++i)
        {
            radii.back() = std::max(radii.back(), (nodes.positions[i] - box.center()).norm());
        }
    }
    return total(radii) / static_cast<double>(radii.size()) / nodes.spacing;
}

TEST(SurfaceNodes, ClustersAndTheirPartsAreCompact)
{
    const SurfaceNodes nodes = nodes_at_vertices(icosphere(2562, "sphere"));
    for (const int size : {SurfaceNodes::cluster_size, SurfaceNodes::part_size})
    {
        // The circumscribed radius of so many nodes as a square, and as a rectangle of 1 : 2, the longest that
        // bisection across the longest extent leaves.
        const double square = std::sqrt(0.5 * size), rectangle = std::sqrt(0.625 * size);
        const double bound  = std::sqrt(0.78125 * size); // 5 spacings for 32 nodes
        const double radius = mean_radius(nodes, static_cast<std::size_t>(size));
        std::printf("%d nodes: mean radius %.2f spacings; square %.2f, rectangle of 1 : 2 %.2f, bound %.2f\n", size,
                    radius, square, rectangle, bound);
        EXPECT_LT(radius, bound);
    }
}

double coefficient_of_variation(const std::vector<double>& values)
{
    const double mean   = total(values) / static_cast<double>(values.size());
    double       square = 0;
    for (const double value : values) { square += (value - mean) * (value - mean); }
    return std::sqrt(square / static_cast<double>(values.size())) / mean;
}

std::vector<double> neighbour_distances(const SurfaceNodes& nodes)
{
    std::vector<double> distances(nodes.positions.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < distances.size(); ++i)
    {
        for (std::size_t j = 0; j < i; ++j)
        {
            const double distance = (nodes.positions[i] - nodes.positions[j]).norm();
            distances[i]          = std::min(distances[i], distance);
            distances[j]          = std::min(distances[j], distance);
        }
    }
    return distances;
}

TEST(SurfaceNodes, AreAsManyAsAskedAndNearUniform)
{
    scene::WheelGenerator wheel{};
    // Its walls and grousers are wider than the spacing: both edges of a narrower strip carry nodes, however near.
    wheel.grousers       = 12;
    wheel.wall_thickness = wheel.grouser_width = wheel.grouser_height = 0.03;
    scene::RockGenerator angular{};
    angular.sphericity = 0.8;
    struct Case
    {
        const char*  name;
        TriangleMesh mesh;
        int          nodes;
        double       variation; ///< bound
    };
    for (const Case& c :
         {Case{"cube", test::cube(1), 162, 0.3}, Case{"cube", test::cube(1), 1000, 0.3},
          Case{"wheel", wheel_mesh(wheel, "wheel"), 3000, 0.4}, Case{"sphere", icosphere(2562, "sphere"), 300, 0.3},
          Case{"rock", rock_mesh({}, "rock"), 20, 0.3}, Case{"rock", rock_mesh({}, "rock"), 162, 0.3},
          Case{"angular rock", rock_mesh(angular, "rock"), 777, 0.3}})
    {
        const SurfaceNodes nodes     = resample_to_count(c.mesh, c.nodes);
        const auto         distances = neighbour_distances(nodes);
        const double       mean      = total(distances) / static_cast<double>(distances.size());
        const double       least     = *std::min_element(distances.begin(), distances.end());
        std::printf("%s, %d nodes: areas vary by %.2f (bound %.1f; random places 0.53), "
                    "nearest neighbours %.2f of the spacing apart (hexagons 1.07, random 0.5), at least %.2f (bound "
                    "0.3)\n",
                    c.name, c.nodes, coefficient_of_variation(nodes.areas), c.variation, mean / nodes.spacing,
                    least / nodes.spacing);
        EXPECT_EQ(nodes.positions.size(), static_cast<std::size_t>(c.nodes));
        // Area sums differ only by rounding of 1e5 terms.
        EXPECT_NEAR(total(nodes.areas), surface_area(c.mesh), 1e-11 * surface_area(c.mesh));
        // Areas of cells of random points vary by 0.53 (Voronoi cells of a Poisson process in the plane). Strips of two
        // spacings between the edges of a wheel hold one or two rows of nodes, neither of which fits.
        EXPECT_LT(coefficient_of_variation(nodes.areas), c.variation);
        EXPECT_GT(mean, 0.65 * nodes.spacing);
        EXPECT_GT(least, 0.3 * nodes.spacing);
        expect_parts_enclose(nodes);
    }
}

TEST(SurfaceNodes, SharpEdgesOfARockCarryNodes)
{
    scene::RockGenerator angular{};
    angular.sphericity        = 0.8;
    angular.solidity          = 1;
    const TriangleMesh mesh   = rock_mesh(angular, "rock");
    const SurfaceNodes nodes  = resample_to_count(mesh, 300);
    double             length = 0, bare = 0;
    for_each_edge(sorted_half_edges(mesh),
                  [&](auto first, auto last)
                  {
                      const auto triangle  = [](const auto& half) { return static_cast<std::size_t>(half->triangle); };
                      const Vector3d one   = area_vector(mesh, triangle(first)),
                                     other = area_vector(mesh, triangle(last - 1));
                      if (one.normalized().dot(other.normalized()) > std::cos(45 * test::pi / 180)) { return; }
                      const Vector3d& low  = mesh.vertices[static_cast<std::size_t>(first->low)];
                      const Vector3d& high = mesh.vertices[static_cast<std::size_t>(first->high)];
                      const double    side = (high - low).norm();
                      length += side;
                      bare += nearest_distance(nodes, 0.5 * (low + high)) > nodes.spacing ? side : 0;
                  });
    std::printf("rock: %.2f m of sharp edges, %.3f of that further than a spacing from a node, bound 0.02\n", length,
                bare / length);
    // With evenly spaced nodes along an edge no point of it is more than half a spacing from one; at corners, edges
    // share.
    EXPECT_GT(length, 1);
    EXPECT_LT(bare, 0.02 * length);
}

TEST(SurfaceNodes, ResamplingMakesOneNodeASpacingSquared)
{
    const SurfaceNodes nodes = resample(test::cube(1), 0.05);
    EXPECT_EQ(nodes.positions.size(), 2400u); // 6 m2 / 0.0025 m2
    EXPECT_NEAR(nodes.spacing, 0.05, 1e-12);
}

TEST(SurfaceNodes, ResamplingHasNodesOnCornersAndEdges)
{
    const SurfaceNodes nodes = resample(test::cube(1), 0.05);
    for (const double x : {-0.5, 0.5})
    {
        for (const double y : {-0.5, 0.5})
        {
            EXPECT_EQ(nearest_distance(nodes, {x, y, 0.5}), 0);
            int on_edge = 0;
            for (const Vector3d& node : nodes.positions) { on_edge += node.x() == x && node.y() == y ? 1 : 0; }
            // At most as far apart as on the faces.
            EXPECT_GE(on_edge, static_cast<int>(1 / (1.7 * 0.05)));
        }
    }
}

TEST(SurfaceNodes, ResamplingHasNodesOnBothSidesOfAThinWall)
{
    const TriangleMesh plate = test::box_mesh({-0.5, -0.5, -0.005}, {0.5, 0.5, 0.005});
    const SurfaceNodes nodes = resample(plate, 0.05);
    double             above = 0, below = 0;
    for (std::size_t i = 0; i < nodes.positions.size(); ++i)
    {
        (nodes.positions[i].z() > 0 ? above : below) += nodes.areas[i];
    }
    // Each side has half of 2.04 m2; only the rim of 0.02 m and half a spacing next to it may be assigned to the other
    // side.
    EXPECT_NEAR(above, 1.02, 0.12);
    EXPECT_NEAR(below, 1.02, 0.12);
}

TEST(SurfaceNodes, ResampledMomentsAreThoseOfTheSurface)
{
    const SurfaceNodes nodes = resample(icosphere(10242, "sphere"), 0.08);
    Vector3d           first = Vector3d::Zero(), second = Vector3d::Zero();
    for (std::size_t i = 0; i < nodes.positions.size(); ++i)
    {
        first += nodes.areas[i] * nodes.positions[i];
        second += nodes.areas[i] * nodes.positions[i].cwiseAbs2();
    }
    // int x = 0 and int x^2 = 4 pi/3. An area is displaced by up to a spacing, in random directions: 0.08/sqrt(2000) =
    // 2e-3.
    EXPECT_LT(first.norm() / (4 * test::pi), 2e-3);
    for (const double moment : {second.x(), second.y(), second.z()}) { EXPECT_NEAR(moment, 4 * test::pi / 3, 0.02); }
}

} // namespace
} // namespace tread::shape
