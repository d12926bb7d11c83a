#include "shape/template.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "shape/generators.hpp"
#include "shape/surface_nodes.hpp"
#include "shape/template_sdf.hpp"
#include "shape/triangle.hpp"

namespace tread::shape
{
namespace
{

constexpr double pi = 3.14159265358979323846;

struct MakeMesh
{
    std::string origin;
    std::string directory;

    TriangleMesh operator()(const scene::RockGenerator& rock) const { return rock_mesh(rock, origin); }
    TriangleMesh operator()(const scene::SphereGenerator& sphere) const { return sphere_mesh(sphere, origin); }
    TriangleMesh operator()(const scene::WheelGenerator& wheel) const { return wheel_mesh(wheel, origin); }
    TriangleMesh operator()(const scene::MeshFile& file) const
    {
        return read_mesh((std::filesystem::path(directory) / file.path).string(), file.unit);
    }
};

/// Volume pi/6 and moment of inertia 2/5 V r^2, r = 1/2 m.
MassProperties exact_sphere() { return {pi / 6, Eigen::Vector3d::Zero(), pi / 60 * Eigen::Matrix3d::Identity()}; }

struct MakeMassProperties
{
    const TriangleMesh& mesh;

    MassProperties operator()(const scene::SphereGenerator&) const { return exact_sphere(); }
    template<class Source>
    MassProperties operator()(const Source&) const
    {
        return mass_properties(mesh);
    }
};

SurfaceNodes sphere_nodes(const TriangleMesh& mesh)
{
    SurfaceNodes nodes = nodes_at_vertices(mesh);
    const double ratio = pi / surface_area(mesh);
    for (double& area : nodes.areas) { area *= ratio; }
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
    SurfaceNodes operator()(const scene::SphereGenerator&) const { return sphere_nodes(mesh); }
    SurfaceNodes operator()(const scene::WheelGenerator& wheel) const { return resampled(wheel.radius / 32); }
    SurfaceNodes operator()(const scene::MeshFile&) const { return resampled(bounds(mesh).extent().maxCoeff() / 40); }

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
    const std::string origin = fmt::format("shape '{}'", shape.name);

    ShapeTemplate result{};
    result.name = shape.name;
    result.mesh = std::visit(MakeMesh{origin, directory}, shape.source);
    require_watertight(result.mesh, origin);

    result.unit        = std::visit(MakeMassProperties{result.mesh}, shape.source);
    result.mesh_centre = result.unit.centre;
    for (Eigen::Vector3d& vertex : result.mesh.vertices) { vertex -= result.mesh_centre; }
    result.unit.centre.setZero();

    result.equivalent_radius        = std::cbrt(3 * result.unit.volume / (4 * pi));
    const TemplateDistance distance = distance_of(shape, result.mesh);
    add_sdf(shape, distance, reach(result.equivalent_radius), result);
    result.nodes           = std::visit(MakeNodes{result.mesh, shape.node_spacing}, shape.source);
    result.box             = bounds(result.mesh);
    result.bounding_radius = bounding_radius(result.mesh);
    if (const auto* wheel = std::get_if<scene::WheelGenerator>(&shape.source))
    {
        result.is_wheel          = true;
        result.wheel             = {wheel->radius, wheel->width};
        result.equivalent_radius = wheel->radius;
    }
    return {std::move(result), distance};
}

} // namespace tread::shape
