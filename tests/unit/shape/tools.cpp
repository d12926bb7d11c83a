#include "shape/generators/tools.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "shape/distance/mesh_distance.hpp"
#include "shape/distance/sdf_report.hpp"
#include "shape/solids/mass_properties.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

/// Round tools have 180 sides: their area and its polar second moment about the axis, for a circumscribed radius.
constexpr double corner_angle = 2 * test::pi / 180;

double polygon_area(double r) { return 0.5 * 180 * r * r * std::sin(corner_angle); }

double polygon_moment(double r) { return polygon_area(r) * r * r / 6 * (2 + std::cos(corner_angle)); }

/// Volume, height of the centre of mass, and moments of inertia about axes x and z through it.
struct Exact
{
    double volume, height, about_x, about_z;
};

/// Prism of a section with this area and polar moment, symmetric about x and y, between two heights.
Exact prism(double area, double polar, double low, double high)
{
    const double length = high - low;
    return {area * length, 0.5 * (low + high), 0.5 * polar * length + area * std::pow(length, 3) / 12, polar * length};
}

/// Bodies on one axis together; a negative volume takes away.
Exact joined(const std::vector<Exact>& parts)
{
    Exact sum{0, 0, 0, 0};
    for (const Exact& part : parts)
    {
        sum.volume += part.volume;
        sum.height += part.volume * part.height;
        sum.about_z += part.about_z;
    }
    sum.height /= sum.volume;
    for (const Exact& part : parts)
    {
        sum.about_x += part.about_x + part.volume * std::pow(part.height - sum.height, 2);
    }
    return sum;
}

Exact less(const Exact& part) { return {-part.volume, part.height, -part.about_x, -part.about_z}; }

Exact round_prism(double r, double low, double high) { return prism(polygon_area(r), polygon_moment(r), low, high); }

Exact rounded_cone(double r, double height)
{
    const double area = polygon_area(r), polar = polygon_moment(r), volume = area * height / 3;
    const double about_tip = polar * height / 10 + area * std::pow(height, 3) / 5;
    return {volume, 0.75 * height, about_tip - volume * std::pow(0.75 * height, 2), polar * height / 5};
}

void expect_exact(const std::string& name, const TriangleMesh& mesh, const Exact& exact)
{
    ASSERT_NO_THROW(require_watertight(mesh, name));
    const MassProperties mass = mass_properties(mesh);
    std::printf(
        "%s: %zu triangles; volume measured %.12g m3, expected %.12g; inertia about x %.12g m5, expected %.12g, "
        "about z %.12g, expected %.12g; tolerance 1e-11 of each: rounding of sums of 5e4 terms that cancel\n",
        name.c_str(), mesh.triangles.size(), mass.volume, exact.volume, mass.inertia(0, 0), exact.about_x,
        mass.inertia(2, 2), exact.about_z);
    EXPECT_NEAR(mass.volume, exact.volume, 1e-11 * exact.volume);
    EXPECT_NEAR(mass.inertia(0, 0), exact.about_x, 1e-11 * exact.about_x);
    EXPECT_NEAR(mass.inertia(2, 2), exact.about_z, 1e-11 * exact.about_z);
    EXPECT_LT(std::hypot(mass.centre.x(), mass.centre.y(), mass.centre.z() - exact.height),
              1e-11 * bounds(mesh).extent().maxCoeff());
    EXPECT_LT(std::abs(mass.inertia(0, 1)) + std::abs(mass.inertia(0, 2)), 1e-11 * exact.about_x);
}

TEST(Tools, WithFlatFacesAreExact)
{
    // About y as about x with x and y exchanged.
    const auto box = [](double x, double y, double low, double high)
    {
        const double volume = x * y * (high - low);
        return Exact{volume, 0.5 * (low + high), volume * (y * y + std::pow(high - low, 2)) / 12,
                     volume * (x * x + y * y) / 12};
    };
    expect_exact("box", tool_mesh(scene::BoxGenerator{{0.1, 0.2, 0.3}}), box(0.1, 0.2, -0.15, 0.15));
    expect_exact("turned box", tool_mesh(scene::BoxGenerator{{0.2, 0.1, 0.3}}), box(0.2, 0.1, -0.15, 0.15));
    expect_exact("plate", tool_mesh(scene::PlateGenerator{std::nullopt, scene::Vector2{0.3, 0.1}, 0.01}),
                 box(0.3, 0.1, -0.005, 0.005));
    expect_exact("frame", tool_mesh(scene::FrameGenerator{{0.06, 0.1}, 0.02, 0.005, 0}),
                 joined({box(0.07, 0.11, -0.01, 0.01), less(box(0.06, 0.1, -0.01, 0.01))}));
    expect_exact("tray", tool_mesh(scene::FrameGenerator{{0.06, 0.1}, 0.02, 0.005, 0.003}),
                 joined({box(0.07, 0.11, -0.01, 0.01), less(box(0.06, 0.1, -0.007, 0.01))}));
}

TEST(Tools, OfRevolutionAreExactPrismsAndPyramids)
{
    expect_exact("disc", tool_mesh(scene::PlateGenerator{0.15, std::nullopt, 0.01}), round_prism(0.15, -0.005, 0.005));
    expect_exact("cylinder", tool_mesh(scene::CylinderGenerator{0.02, 0.5}), round_prism(0.02, -0.25, 0.25));
    expect_exact("tube", tool_mesh(scene::TubeGenerator{0.05, 0.004, 0.1}),
                 joined({round_prism(0.05, -0.05, 0.05), less(round_prism(0.046, -0.05, 0.05))}));
    expect_exact("ring", tool_mesh(scene::RingGenerator{0.05, 0.1, 0.01, 0, 0, 0}),
                 joined({round_prism(0.1, -0.005, 0.005), less(round_prism(0.05, -0.005, 0.005))}));
    const double height = 0.01 / std::tan(15 * test::pi / 180);
    expect_exact("cone", tool_mesh(scene::ConeGenerator{30, 0.01, 0, 0}), rounded_cone(0.01, height));
    expect_exact("penetrometer", tool_mesh(scene::ConeGenerator{30, 0.01, 0.008, 0.2}),
                 joined({rounded_cone(0.01, height), round_prism(0.008, height, height + 0.2)}));
    expect_exact("pointed bar", tool_mesh(scene::ConeGenerator{30, 0.01, 0.01, 0.2}),
                 joined({rounded_cone(0.01, height), round_prism(0.01, height, height + 0.2)}));
    // Against the circle: 180 sides take (2 pi/180)^2/6 of its area.
    EXPECT_NEAR(polygon_area(1) / test::pi, 1 - corner_angle * corner_angle / 6, 1e-7);
}

/// Area within radius r, on one side of the axis, of a slab as thick as a vane.
double slab(double r, double half) { return half * std::sqrt(r * r - half * half) + r * r * std::asin(half / r); }

/// Polar moment of one vane's section, by 2000 strips along it.
double vane_moment(const scene::RingGenerator& ring)
{
    constexpr int steps = 2000;
    const double  width = ring.vane_thickness / steps;
    double        sum   = 0;
    for (int i = 0; i < steps; ++i)
    {
        const double x    = (i + 0.5) * width - 0.5 * ring.vane_thickness;
        const double low  = std::sqrt(ring.inner_radius * ring.inner_radius - x * x);
        const double high = std::sqrt(ring.outer_radius * ring.outer_radius - x * x);
        sum += width * (x * x * (high - low) + (std::pow(high, 3) - std::pow(low, 3)) / 3);
    }
    return sum;
}

bool is_inside(const scene::RingGenerator& ring, const Eigen::Vector3d& point)
{
    const double radius = std::hypot(point.x(), point.y());
    if (radius < ring.inner_radius || radius > ring.outer_radius || point.z() > 0.5 * ring.height) { return false; }
    if (point.z() > -0.5 * ring.height) { return true; }
    if (point.z() < -0.5 * ring.height - ring.vane_height) { return false; }
    const double off = std::remainder(std::atan2(point.y(), point.x()), 2 * test::pi / ring.vanes);
    return std::cos(off) > 0 && std::abs(radius * std::sin(off)) < 0.5 * ring.vane_thickness;
}

TEST(Tools, ShearRingHasItsVanes)
{
    for (const auto& ring : {scene::RingGenerator{0.06, 0.09, 0.01, 12, 0.012, 0.003},
                             scene::RingGenerator{0.02, 0.1, 0.02, 1, 0.005, 0.03},
                             scene::RingGenerator{0.05, 0.06, 0.03, 60, 0.02, 0.001}})
    {
        const TriangleMesh mesh = tool_mesh(ring);
        ASSERT_NO_THROW(require_watertight(mesh, "ring"));
        const double half = 0.5 * ring.vane_thickness, inner = ring.inner_radius, outer = ring.outer_radius;
        const double vanes = ring.vanes * ring.vane_height;
        const double volume =
            test::pi * (outer * outer - inner * inner) * ring.height + vanes * (slab(outer, half) - slab(inner, half));
        const double about_z =
            0.5 * test::pi * (std::pow(outer, 4) - std::pow(inner, 4)) * ring.height + vanes * vane_moment(ring);
        const MassProperties mass = mass_properties(mesh);
        // About the axis, on which the centre of mass of a ring with one vane is not.
        const double found = mass.inertia(2, 2) + mass.volume * mass.centre.head<2>().squaredNorm();
        // Chords of at most 2 degrees take 2.03e-4 of a disc and twice that of its polar moment.
        std::printf(
            "%d vanes, %zu triangles: volume measured %.8g m3, expected %.8g, tolerance 2.1e-4; inertia about z "
            "%.8g m5, expected %.8g, tolerance 4.2e-4\n",
            ring.vanes, mesh.triangles.size(), mass.volume, volume, found, about_z);
        EXPECT_NEAR(mass.volume, volume, 2.1e-4 * volume);
        EXPECT_NEAR(found, about_z, 4.2e-4 * about_z);

        const MeshDistance field = prepare_distance(mesh);
        Random             random(5);
        for (int k = 0; k < 4000; ++k)
        {
            const Eigen::Vector3d point(random.uniform(-1.05, 1.05) * outer, random.uniform(-1.05, 1.05) * outer,
                                        random.uniform(-ring.height - ring.vane_height, ring.height));
            const double          distance = signed_distance(field, point);
            // Chords leave 1.5e-4 of the radius between mesh and circle.
            if (std::abs(distance) < 2e-4 * outer) { continue; }
            ASSERT_EQ(distance < 0, is_inside(ring, point)) << point.transpose();
        }
    }
}

std::vector<scene::Shape> tools()
{
    const auto shape = [](const std::string& name, const scene::ShapeSource& source) {
        return scene::Shape{name, source, std::nullopt, 0.0};
    };
    return {shape("box", scene::BoxGenerator{{0.1, 0.2, 0.15}}),
            shape("square plate", scene::PlateGenerator{std::nullopt, scene::Vector2{0.2, 0.2}, 0.01}),
            shape("disc", scene::PlateGenerator{0.1, std::nullopt, 0.01}),
            shape("cylinder", scene::CylinderGenerator{0.05, 0.2}),
            shape("penetrometer", scene::ConeGenerator{30, 0.010135, 0.00794, 0.06}),
            shape("shear ring", scene::RingGenerator{0.06, 0.09, 0.01, 12, 0.012, 0.006}),
            shape("tube", scene::TubeGenerator{0.05, 0.005, 0.06}),
            shape("frame", scene::FrameGenerator{{0.06, 0.06}, 0.02, 0.005, 0}),
            shape("tray", scene::FrameGenerator{{0.06, 0.06}, 0.02, 0.005, 0.005})};
}

TEST(FullSizeTools, FieldsOfTheirDefaultCellsKeepSurfaceAndVolume)
{
    for (const scene::Shape& tool : tools())
    {
        const MeasuredTemplate measured = make_measured_template(tool, "", [](double) { return 0.0; });
        const ShapeTemplate&   form     = measured.form;
        const SdfQuality       found    = sdf_convergence(measured, {form.sdf_cells}).front();
        const double           cell     = form.sdf.spacing / form.box.extent().maxCoeff();
        // Faces are exact. The interpolant rounds edges: by under half a cell at a right angle, by under a cell at the
        // tip of a cone of 30 degrees.
        std::printf("%s: %d cells, |phi| %.3f cells in the mean (tolerance 0.1), %.2f at most (1), volume %.4f "
                    "(tolerance 2 %%: beyond it the scene is warned of), %zu nodes\n",
                    tool.name.c_str(), found.cells, found.mean_surface / cell, found.worst_surface / cell,
                    found.volume_ratio, form.nodes.positions.size());
        EXPECT_LT(found.mean_surface, 0.1 * cell) << tool.name;
        EXPECT_LT(found.worst_surface, cell) << tool.name;
        EXPECT_NEAR(found.volume_ratio, 1, 0.02) << tool.name;
        EXPECT_TRUE(form.warnings.empty()) << tool.name << ": " << form.warnings.front();
    }
}

/// Distance (m) from a place to the nearest surface node, in the body's frame.
double nearest_node(const ShapeTemplate& form, const Eigen::Vector3d& place)
{
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& node : form.nodes.positions)
    {
        nearest = std::min(nearest, (node + form.mesh_centre - place).norm());
    }
    return nearest;
}

TEST(Tools, CarryNodesOnCornersEdgesAndTips)
{
    const auto made = [](const scene::ShapeSource& source) { return make_template({"tool", source, 40, 0.0}, ""); };
    const ShapeTemplate box = made(scene::BoxGenerator{{0.1, 0.2, 0.15}});
    for (int c = 0; c < 8; ++c)
    {
        const Eigen::Vector3d corner(c & 1 ? 0.05 : -0.05, c & 2 ? 0.1 : -0.1, c & 4 ? 0.075 : -0.075);
        EXPECT_LT(nearest_node(box, corner), 1e-12);
    }
    const ShapeTemplate cone = made(scene::ConeGenerator{30, 0.01, 0, 0});
    EXPECT_LT(nearest_node(cone, {0, 0, 0}), 1e-12) << "no node at the tip";
    const double base = 0.01 / std::tan(15 * test::pi / 180);
    for (int i = 0; i < 36; ++i)
    {
        const double angle = 2 * test::pi * i / 36;
        EXPECT_LT(nearest_node(cone, {0.01 * std::cos(angle), 0.01 * std::sin(angle), base}), cone.nodes.spacing);
    }
    const ShapeTemplate ring = made(scene::RingGenerator{0.06, 0.09, 0.01, 4, 0.012, 0.006});
    for (const double side : {-0.003, 0.003})
    {
        // The lower edge of the vane along x, from its inner to its outer end.
        EXPECT_LT(nearest_node(ring, {std::sqrt(0.06 * 0.06 - side * side), side, -0.017}), 1e-12);
        EXPECT_LT(nearest_node(ring, {0.075, side, -0.017}), ring.nodes.spacing);
        EXPECT_LT(nearest_node(ring, {std::sqrt(0.09 * 0.09 - side * side), side, -0.017}), 1e-12);
    }
    for (const ShapeTemplate* form : {&box, &cone, &ring})
    {
        const double area = std::accumulate(form->nodes.areas.begin(), form->nodes.areas.end(), 0.0);
        EXPECT_NEAR(area, surface_area(form->mesh), 1e-9 * area);
    }
}

} // namespace
} // namespace tread::shape
