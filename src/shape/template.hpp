#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "scene/scene.hpp"
#include "shape/distance/mesh_distance.hpp"
#include "shape/mesh/mesh.hpp"
#include "shape/solids/mass_properties.hpp"

namespace tread::shape
{

/// Signed distance on a uniform grid, negative inside. Body frame (centre of mass at the origin, mesh axes), metres.
/// Node (i, j, k) is at origin + spacing * (i, j, k). Stored in one of two ways:
/// Dense (slots empty): values[i + nodes[0] * (j + nodes[1] * k)].
/// Bricks of 8^3 cells: a brick near the surface stores all its 9^3 nodes, x fastest, from 729 * slot on in `values`;
/// any other (slot -1) only the nodes at its corners, in `corners`, whose trilinear interpolant then covers the whole
/// brick. Nodes of a fine brick on the face of a coarse one hold that interpolant, so that the field is continuous.
struct SignedDistanceGrid
{
    static constexpr std::int32_t brick_cells = 8;
    static constexpr std::int32_t brick_nodes = brick_cells + 1;

    Eigen::Vector3d             origin;
    double                      spacing;
    std::array<std::int32_t, 3> nodes;
    std::vector<float>          values;
    std::array<std::int32_t, 3> bricks{}; ///< along each axis; they may extend beyond `nodes`
    std::vector<std::int32_t>   slots;    ///< of the bricks, x fastest
    std::vector<float>          corners;  ///< of the bricks: bricks + 1 along each axis, x fastest
    double fine_reach = std::numeric_limits<double>::infinity(); ///< m; nodes nearer to the surface are exact

    std::size_t bytes() const
    {
        return sizeof(float) * (values.size() + corners.size()) + sizeof(std::int32_t) * slots.size();
    }
};

/// Surface nodes that carry contact traction; areas sum to the surface's area. Ordered so that each run of cluster_size
/// nodes, a cluster, is compact, and each run of part_size within it, which has a bounding sphere (the last may be
/// shorter).
struct SurfaceNodes
{
    static constexpr int cluster_size = 32, part_size = 8;

    std::vector<Eigen::Vector3d> positions; ///< body frame
    std::vector<double>          areas;     ///< m2, tributary
    std::vector<Eigen::Vector3d> part_centres;
    std::vector<double>          part_radii;
    double                       spacing; ///< m, sqrt(area / count)
};

/// Additional geometry of a wheel: the axle is the mesh's y axis.
struct WheelGeometry
{
    double radius; ///< m, over the grousers
    double width;  ///< m
};

/// One shape at scale 1, shared by all its instances through scale and rotation. Body frame: centre of mass at the
/// origin, mesh axes (not principal axes: the inertia tensor is full). A generated sphere has the exact mass
/// properties, areas and SDF of a sphere; only its mesh has facets.
struct ShapeTemplate
{
    std::string        name;
    TriangleMesh       mesh;
    MassProperties     unit;        ///< density 1; unit.centre is zero
    Eigen::Vector3d    mesh_centre; ///< centre of mass in the frame of the source mesh
    SignedDistanceGrid sdf;
    int                sdf_cells;        ///< along the longest axis of the 120 % box
    double             sdf_volume_ratio; ///< volume enclosed by the SDF's interpolant over the true one
    SurfaceNodes       nodes;
    Bounds             box;
    double             bounding_radius;   ///< m, about the centre of mass
    double             equivalent_radius; ///< m, of the sphere of equal volume; R of the contact law (wheels: radius)
    double             sphere_radius;     ///< m, of a generated sphere; 0 of any other shape
    double             hull_depth;        ///< m, depth of the deepest surface node below the convex hull; 0 = convex
    bool               is_wheel;
    WheelGeometry      wheel; ///< meaningful if is_wheel
    SignRule           sign;  ///< method that defined the inside

    std::vector<std::string> remarks;  ///< changes to a mesh file and their meaning, one line each
    std::vector<std::string> warnings; ///< shortcomings of the SDF and remedies, one line each
};

/// Names of the built-in wheels, which a scene may use without a [[shape]] table.
std::vector<std::string> builtin_shape_names();

/// The scene's shape called `name`, with the shapes of its parts if it is an assembly, or the built-in one; InputError
/// if there is none.
scene::Shape find_shape(const scene::Scene& scene, const std::string& name);

/// One shape for each rock of a family, named "clast-0", "clast-1" ..., with seeds derived from the family's; the first
/// is the rock of the family's own seed. Just {shape} if it is not a rock, or only one.
std::vector<scene::Shape> members(const scene::Shape& shape);

/// Distance outside a template up to which its field is needed, m at scale 1, as a function of its equivalent radius.
using Reach = std::function<double(double equivalent_radius)>;

/// Builds mesh, mass properties, surface nodes and SDF of one shape, with checks. Paths are relative to `directory`.
/// Generated rocks and spheres have an equivalent diameter of 1 m at scale 1, so an instance's scale is its diameter in
/// metres. Throws InputError that names the shape or the file. The SDF covers 120 % of the box, and `reach` beyond the
/// mesh: farther out it gives only a lower bound, which contacts must not use.
ShapeTemplate make_template(
    const scene::Shape& shape, const std::string& directory, const Reach& reach = [](double) { return 0.0; });

/// Signed distance (m) at `point` (body frame) by trilinear interpolation. Outside the grid a positive lower bound: the
/// root of the sum of squares of the distance to the grid's box and of the value (at least 0) at the box's nearest
/// point.
double sample(const SignedDistanceGrid& sdf, const Eigen::Vector3d& point);

/// Exact gradient of the value of `sample`, inside and outside the grid, not normalised.
Eigen::Vector3d sample_gradient(const SignedDistanceGrid& sdf, const Eigen::Vector3d& point);

} // namespace tread::shape
