#include "shape/surface_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

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

void expect_clusters_enclose(const SurfaceNodes& nodes)
{
    const std::size_t count = nodes.positions.size();
    ASSERT_EQ(nodes.areas.size(), count);
    ASSERT_EQ(nodes.cluster_centres.size(), (count + SurfaceNodes::cluster_size - 1) / SurfaceNodes::cluster_size);
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t c = i / SurfaceNodes::cluster_size;
        ASSERT_LE((nodes.positions[i] - nodes.cluster_centres[c]).norm(), nodes.cluster_radii[c] * (1 + 1e-12));
    }
}

TEST(SurfaceNodes, VerticesShareTheArea)
{
    const TriangleMesh mesh  = test::ellipsoid({1, 0.775, 0.55}, 642);
    const SurfaceNodes nodes = nodes_at_vertices(mesh);
    EXPECT_EQ(nodes.positions.size(), 642u);
    EXPECT_NEAR(total(nodes.areas), surface_area(mesh), 1e-12);
    EXPECT_DOUBLE_EQ(nodes.spacing, std::sqrt(total(nodes.areas) / 642));
    expect_clusters_enclose(nodes);
}

TEST(SurfaceNodes, ClustersAreCompact)
{
    const SurfaceNodes nodes = nodes_at_vertices(icosphere(2562, "sphere"));
    const double       mean  = total(nodes.cluster_radii) / static_cast<double>(nodes.cluster_radii.size());
    // 32 nodes have a circumscribed radius of 3.2 spacings as a disc, 4.0 as a square, and 4.5 as a rectangle of 1 : 2,
    // which is the longest that halving across the longest extent leaves.
    std::printf("mean cluster radius: measured %.2f spacings; square 4.0, rectangle of 1 : 2 4.5, bound 5\n",
                mean / nodes.spacing);
    EXPECT_LT(mean, 5 * nodes.spacing);
}

TEST(SurfaceNodes, ResamplingKeepsTheAreaAndIsNearUniform)
{
    struct Case
    {
        const char*  name;
        TriangleMesh mesh;
        double       spacing;
    };
    for (const Case& c : {Case{"cube", test::cube(1), 0.04}, Case{"sphere", icosphere(10242, "sphere"), 0.08},
                          Case{"wheel", wheel_mesh({}, "wheel"), 0.008}})
    {
        const SurfaceNodes nodes = resample(c.mesh, c.spacing);
        const auto [least, most] = std::minmax_element(nodes.areas.begin(), nodes.areas.end());
        const double mean        = total(nodes.areas) / static_cast<double>(nodes.areas.size());
        std::printf("%s: %zu nodes, spacing %.4f of the asked, areas %.2f to %.2f of the mean\n", c.name,
                    nodes.areas.size(), nodes.spacing / c.spacing, *least / mean, *most / mean);
        // Area sums differ by rounding of 1e5 terms alone.
        EXPECT_NEAR(total(nodes.areas), surface_area(c.mesh), 1e-11 * surface_area(c.mesh));
        // Thinning packs between the densest (0.79 of what is asked) and the loosest that covers (1.37).
        EXPECT_NEAR(nodes.spacing, c.spacing, 0.25 * c.spacing);
        EXPECT_GT(*least, 0.2 * mean);
        EXPECT_LT(*most, 3 * mean);
        expect_clusters_enclose(nodes);
    }
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
            // Thinning by halves leaves neighbours on an edge between 0.85 and 1.7 spacings apart.
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
    // Each side has half of 2.04 m2; only the rim of 0.02 m and half a spacing next to it may go to the other side.
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
    // int x = 0 and int x^2 = 4 pi/3. An area moves by up to a spacing, in random directions: 0.08/sqrt(2000) = 2e-3.
    EXPECT_LT(first.norm() / (4 * test::pi), 2e-3);
    for (const double moment : {second.x(), second.y(), second.z()}) { EXPECT_NEAR(moment, 4 * test::pi / 3, 0.02); }
}

} // namespace
} // namespace tread::shape
