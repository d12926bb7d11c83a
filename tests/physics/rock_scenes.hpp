#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "harness.hpp"
#include "shape/generators/generators.hpp"
#include "temporary_directory.hpp"

// Scenes of rigid bodies only, and the meshes that they use.
namespace tread::test
{

inline constexpr double earth = 9.81; ///< m/s2

/// An open or walled box under gravity, tilted by `degrees` about y: downslope is +x.
inline std::string rock_domain(const Vec3<double>& size, double degrees, const std::string& walls,
                               const std::string& numerics)
{
    const double angle = degrees * std::numbers::pi / 180;
    return fmt::format(R"(
title = "rocks"
[domain]
size    = [{}, {}, {}]
gravity = [{}, 0.0, {}]
walls   = {{ {} }}
[numerics]
{}
)",
                       size[0], size[1], size[2], earth * std::sin(angle), -earth * std::cos(angle), walls, numerics);
}

inline std::string stone(double young, double friction, double restitution)
{
    return fmt::format(R"(
[[material]]
name = "stone"
model = "elastic"
density = 2700.0
young = {}
poisson = 0.25
[[contact]]
between = ["stone", "stone"]
friction = {}
restitution = {}
[[contact]]
between = ["stone", "wall"]
friction = {}
restitution = {}
)",
                       young, friction, restitution, friction, restitution);
}

/// A block of sand that no body touches, elastic so that it comes to rest at once: it gives the scene sand's steps, and
/// the substeps of bodies in sand.
inline constexpr const char* sand_apart = R"(
[grid]
spacing = 0.05
[[material]]
name = "sand"
model = "elastic"
density = 1600.0
young = 1.0e6
poisson = 0.3
[[contact]]
between = ["sand", "stone"]
friction = 0.3
[[terrain]]
material = "sand"
region = { box = [[0.0, 0.0, 0.0], [0.2, 0.2, 0.1]] }
)";

/// Mesh of a box, 12 triangles.
inline shape::TriangleMesh box_mesh(const Vec3<double>& half)
{
    shape::TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
    {
        mesh.vertices.push_back(half.cwiseProduct(
            Vec3<double>((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1)));
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// |x|^8 + |y|^8 + |z|^8 = 1: a cube with rounded edges.
inline shape::TriangleMesh rounded_cube_mesh()
{
    shape::TriangleMesh mesh = shape::icosphere(2562, "test");
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex /= std::pow(vertex.array().pow(8.0).sum(), 1.0 / 8); }
    return mesh;
}

/// A mesh file, in a folder that exists as long as this object.
class MeshFile
{
public:
    explicit MeshFile(const shape::TriangleMesh& mesh)
        : path_(folder_.path("mesh.stl"))
    {
        shape::write_stl(mesh, path_);
    }

    const std::string& path() const { return path_; }

private:
    TemporaryDirectory folder_;
    std::string        path_;
};

inline std::string file_shape(const std::string& name, const MeshFile& file, double node_spacing, int cells)
{
    return fmt::format(R"(
[[shape]]
name = "{}"
file = "{}"
node_spacing = {}
sdf_cells = {}
)",
                       name, file.path(), node_spacing, cells);
}

inline std::string phase(const std::string& name, double damping, double duration)
{
    return fmt::format("\n[[phase]]\nname = \"{}\"\ndamping = {}\nduration = {}\n", name, damping, duration);
}

} // namespace tread::test
