#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "dem_scene.hpp"
#include "shape/distance/mesh_distance.hpp"
#include "shape/distance/sdf_grid.hpp"
#include "shape/generators/generators.hpp"
#include "shape/solids/mass_properties.hpp"
#include "shape/surface_nodes.hpp"

// A bumpy, concave body of about 1 m, whose surface does not depend on its number of nodes.
namespace tread::test
{

/// Radius (m) in the unit direction n: bumps of a tenth, some 0.6 m apart.
inline double bumpy_radius(const Vec3<double>& n)
{
    return 1 + 0.06 * std::sin(5 * n[0] + 1) + 0.05 * std::sin(6 * n[1] + 2) * std::cos(4 * n[2]) +
           0.04 * std::cos(7 * n[2] - 3 * n[0]);
}

inline shape::TriangleMesh bumpy_mesh(int nodes)
{
    shape::TriangleMesh mesh = shape::icosphere(nodes, "test");
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex *= bumpy_radius(vertex); }
    return mesh;
}

class BumpyBody
{
public:
    explicit BumpyBody(int cells)
    {
        shape::TriangleMesh fine = bumpy_mesh(10242);
        mass_                    = shape::mass_properties(fine);
        for (Eigen::Vector3d& vertex : fine.vertices)
        {
            vertex -= mass_.centre;
            half_            = half_.cwiseMax(vertex.cwiseAbs());
            bounding_radius_ = std::max(bounding_radius_, vertex.norm());
        }
        const shape::MeshDistance distance = shape::prepare_distance(fine);
        sdf_                               = shape::build_sdf(
                                          {-half_, half_}, cells,
                                          [&](const Eigen::Vector3d& x, double within) { return shape::signed_distance(distance, x, within); }, 0,
                                          shape::Storage::dense);
    }

    /// Shape with 162, 642 or 2562 nodes.
    SolidShape shape(int nodes) const
    {
        shape::TriangleMesh mesh = bumpy_mesh(nodes);
        for (Eigen::Vector3d& vertex : mesh.vertices) { vertex -= mass_.centre; }
        const shape::SurfaceNodes surface = shape::nodes_at_vertices(mesh);
        SolidShape                found;
        found.spacing           = sdf_.spacing;
        found.origin            = sdf_.origin;
        found.nodes             = sdf_.nodes;
        found.values            = sdf_.values;
        found.positions         = surface.positions;
        found.areas             = surface.areas;
        found.centres           = surface.part_centres;
        found.radii             = surface.part_radii;
        found.half              = half_;
        found.bounding_radius   = bounding_radius_;
        found.equivalent_radius = std::cbrt(0.75 * mass_.volume / std::numbers::pi);
        return found;
    }

    /// An instance at this scale.
    Solid solid(double scale, double density) const
    {
        const double cube = scale * scale * scale;
        Solid        found;
        found.scale   = scale;
        found.mass    = density * cube * mass_.volume;
        found.inertia = density * cube * scale * scale * mass_.inertia;
        return found;
    }

private:
    shape::MassProperties     mass_{};
    shape::SignedDistanceGrid sdf_;
    Vec3<double>              half_            = Vec3<double>::Zero();
    double                    bounding_radius_ = 0;
};

inline constexpr std::int32_t heap_count = 8;

/// Spinning bumpy bodies of 0.1 m that overlap each other and the ground.
inline std::vector<Solid> bumpy_heap(const BumpyBody& bumpy)
{
    std::vector<Solid> solids;
    for (int i = 0; i < heap_count; ++i)
    {
        Solid solid    = bumpy.solid(0.1, 2000);
        solid.position = {0.19 * (i % 2), 0.19 * (i / 2 % 2), 0.098 + 0.19 * (i / 4)};
        solid.spin     = {0.1 * i, 1.0, -0.2 * i};
        solids.push_back(solid);
    }
    return solids;
}

} // namespace tread::test
