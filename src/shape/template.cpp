#include "shape/template.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "shape/distance/template_sdf.hpp"
#include "shape/generators/tools.hpp"
#include "shape/hull_depth.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/solids/source_solid.hpp"
#include "shape/solids/united.hpp"
#include "shape/surface_nodes.hpp"

namespace tread::shape
{
namespace
{

/// Projects nodes of an inscribed mesh onto the sphere of diameter 1 m.
SurfaceNodes on_sphere(SurfaceNodes nodes, const TriangleMesh& mesh)
{
    const double ratio = std::numbers::pi / surface_area(mesh);
    for (double& area : nodes.areas) { area *= ratio; }
    for (Eigen::Vector3d& position : nodes.positions) { position *= 0.5 / position.norm(); }
    // A node on a facet moves out by at most the depth of the facet below the sphere: its part's sphere grows by
    // that.
    double moved = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        moved = std::max(moved, 0.5 - area_vector(mesh, t).normalized().dot(corner(mesh, t, 0)));
    }
    for (double& radius : nodes.part_radii) { radius += moved; }
    nodes.spacing *= std::sqrt(ratio);
    return nodes;
}

struct MakeNodes
{
    const TriangleMesh& mesh;
    double              spacing; ///< m, 0 = default

    SurfaceNodes operator()(const scene::RockGenerator& rock) const
    {
        return spacing > 0 ? resample(mesh, spacing) : resample_to_count(mesh, rock.nodes);
    }
    SurfaceNodes operator()(const scene::SphereGenerator&) const
    {
        return on_sphere(spacing > 0 ? resample(mesh, spacing) : nodes_at_vertices(mesh), mesh);
    }
    SurfaceNodes operator()(const scene::WheelGenerator& wheel) const { return resampled(wheel.radius / 32); }
    SurfaceNodes operator()(const scene::MeshFile&) const { return resampled(bounds(mesh).extent().maxCoeff() / 40); }
    SurfaceNodes operator()(const scene::Assembly&) const { return resampled(bounds(mesh).extent().maxCoeff() / 40); }

    template<class Tool>
    SurfaceNodes operator()(const Tool& tool) const
    {
        return resampled(tool_spacing(tool));
    }

    SurfaceNodes resampled(double usual) const { return resample(mesh, spacing > 0 ? spacing : usual); }
};

double bounding_radius(const TriangleMesh& mesh)
{
    double squared = 0;
    for (const Eigen::Vector3d& vertex : mesh.vertices) { squared = std::max(squared, vertex.squaredNorm()); }
    return std::sqrt(squared);
}

} // namespace

ShapeTemplate make_template(const scene::Shape& shape, const std::string& directory, const Reach& reach)
{
    return make_measured_template(shape, directory, reach).form;
}

MeasuredTemplate make_measured_template(const scene::Shape& shape, const std::string& directory, const Reach& reach)
{
    ShapeTemplate result{};
    result.name = shape.name;
    Solid solid = solid_of(shape, directory);

    result.unit        = solid.unit;
    result.mesh_centre = result.unit.centre;
    result.unit.centre.setZero();
    place(solid, {1, Eigen::Matrix3d::Identity(), -result.mesh_centre});

    result.mesh                     = solid.surface;
    result.sign                     = solid.sign;
    result.remarks                  = solid.remarks;
    result.equivalent_radius        = std::cbrt(3 * result.unit.volume / (4 * std::numbers::pi));
    const TemplateDistance distance = distance_of(shape, solid);
    add_sdf(shape, distance, reach(result.equivalent_radius), result);
    result.nodes           = std::visit(MakeNodes{result.mesh, shape.node_spacing}, shape.source);
    result.box             = bounds(result.mesh);
    result.bounding_radius = bounding_radius(result.mesh);
    result.hull_depth      = hull_depth(result.mesh, result.nodes.positions);
    if (std::holds_alternative<scene::SphereGenerator>(shape.source))
    {
        result.sphere_radius = result.equivalent_radius;
    }
    if (const auto* wheel = std::get_if<scene::WheelGenerator>(&shape.source))
    {
        result.is_wheel          = true;
        result.wheel             = {wheel->radius, wheel->width};
        result.equivalent_radius = wheel->radius;
    }
    return {std::move(result), distance};
}

} // namespace tread::shape
