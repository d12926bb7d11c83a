#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace tread::shape
{

/// An indexed triangle surface, counter-clockwise seen from outside. Lengths in metres.
struct TriangleMesh
{
    std::vector<Eigen::Vector3d>             vertices;
    std::vector<std::array<std::int32_t, 3>> triangles;
};

/// Axis-aligned bounding box of a set of points.
struct Bounds
{
    Eigen::Vector3d low;
    Eigen::Vector3d high;

    Eigen::Vector3d extent() const { return high - low; }
};

Bounds bounds(const TriangleMesh& mesh);

/// Describes why the mesh is not a closed surface: one line per kind of defect, with the count and the position of the
/// first. Empty if it is closed.
std::string describe_defects(const TriangleMesh& mesh);

/// Throws InputError, naming `origin`, unless the mesh is closed, consistently oriented outwards, non-degenerate and of
/// positive volume; the message counts the bad edges or triangles and gives the position of the first.
void require_watertight(const TriangleMesh& mesh, const std::string& origin);

/// Reads binary or ASCII STL, or OBJ, recognised by content and extension; equal corners are welded; `unit`: metres per
/// mesh unit. Throws InputError that names the file (and the line in text files).
TriangleMesh read_mesh(const std::string& path, double unit);

void write_stl(const TriangleMesh& mesh, const std::string& path);

} // namespace tread::shape
