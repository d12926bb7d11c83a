#include <cstdio>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "shape/distance/mesh_distance.hpp"
#include "shape/template.hpp"
#include "unit/shape/meshes.hpp"

// Compares inside and outside by the sign of the distance and by the sum of all solid angles, which uses neither the
// tree nor the pseudonormals.
namespace tread::shape
{
namespace
{

using Eigen::Vector3d;

constexpr int count = 20000;

void expect_same_inside(const TriangleMesh& mesh, const char* name)
{
    const MeshDistance                     distance = prepare_distance(mesh);
    const Bounds                           box      = bounds(mesh);
    std::mt19937_64                        random(5);
    std::uniform_real_distribution<double> unit(-0.05, 1.05);
    std::vector<Vector3d>                  points;
    for (int i = 0; i < count; ++i)
    {
        const double x = unit(random), y = unit(random), z = unit(random);
        points.push_back(box.low + Vector3d(x, y, z).cwiseProduct(box.extent()));
    }
    int inside = 0, wrong = 0;
#pragma omp parallel for schedule(dynamic, 64) reduction(+ : inside, wrong)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const bool within = test::winding_number(mesh, points[i]) > 0.5;
        inside += within ? 1 : 0;
        wrong += within != (signed_distance(distance, points[i]) < 0) ? 1 : 0;
    }
    std::printf("%s: %zu triangles, %d points, %d inside, %d of wrong sign (expected 0)\n", name, mesh.triangles.size(),
                count, inside, wrong);
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inside, count / 100);
}

TEST(Inside, Sphere) { expect_same_inside(icosphere(642, "sphere"), "sphere"); }

TEST(Inside, Rocks)
{
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
    {
        scene::RockGenerator rock;
        rock.seed = seed;
        expect_same_inside(rock_mesh(rock, "rock"), "rock");
    }
}

TEST(Inside, BuiltInWheels)
{
    for (const std::string& name : builtin_shape_names())
    {
        const scene::Shape shape = find_shape({}, name);
        const auto*        wheel = std::get_if<scene::WheelGenerator>(&shape.source);
        ASSERT_NE(wheel, nullptr);
        expect_same_inside(wheel_mesh(*wheel, name), name.c_str());
    }
}

} // namespace
} // namespace tread::shape
