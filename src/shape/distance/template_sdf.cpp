#include "shape/distance/template_sdf.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "shape/mesh/thickness.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/solids/united.hpp"

namespace tread::shape
{
namespace
{

constexpr int    least_cells = 40, most_stone_cells = 64, most_cells = 512;
constexpr double volume_tolerance = 0.02;

bool is_sphere(const scene::Shape& shape) { return std::holds_alternative<scene::SphereGenerator>(shape.source); }

bool is_stone(const scene::Shape& shape)
{
    return is_sphere(shape) || std::holds_alternative<scene::RockGenerator>(shape.source);
}

/// At most one cell per surface node: nodes resolve nothing finer.
int stone_cells(const scene::Shape& shape, const ShapeTemplate& form)
{
    const auto*  rock    = std::get_if<scene::RockGenerator>(&shape.source);
    const double nodes   = rock != nullptr ? rock->nodes : static_cast<double>(form.mesh.vertices.size());
    const double spacing = std::sqrt(surface_area(form.mesh) / nodes);
    const double wanted  = 1.2 * bounds(form.mesh).extent().maxCoeff() / spacing;
    return std::clamp(static_cast<int>(std::ceil(wanted)), least_cells, most_stone_cells);
}

int wall_cells(const MeshDistance& of_mesh, ShapeTemplate& form)
{
    const double thickness = thinnest_wall(form.mesh, of_mesh.tree);
    const int    wanted    = cells_for_wall(bounds(form.mesh), thickness);
    if (wanted > most_cells)
    {
        form.warnings.push_back(
            fmt::format("its walls, {:.3g} m thin, want sdf_cells = {}; it has {}, the most that \"auto\" takes",
                        thickness, wanted, most_cells));
    }
    return std::min(wanted, most_cells);
}

/// Smallest number of cells, from a sequence up to most_cells, whose volume is within the tolerance; 0 if none is.
int cells_that_do(const ShapeTemplate& form, const SignedDistance& distance)
{
    constexpr double step  = 1.25;
    const Bounds     box   = bounds(form.mesh);
    int              cells = form.sdf_cells;
    while (cells < most_cells)
    {
        cells = std::min(static_cast<int>(std::ceil(step * cells)), most_cells);
        if (std::abs(enclosed_volume_with(box, cells, distance) / form.unit.volume - 1) <= volume_tolerance)
        {
            return cells;
        }
    }
    return 0;
}

/// Cells for the thinnest wall or, where these lose over 2 % of the volume at its edges, as many more as do not.
int volume_cells(const TemplateDistance& distance, ShapeTemplate& form)
{
    form.sdf_cells     = wall_cells(*distance.mesh, form);
    const double ratio = enclosed_volume_with(bounds(form.mesh), form.sdf_cells, distance.function) / form.unit.volume;
    if (std::abs(ratio - 1) <= volume_tolerance) { return form.sdf_cells; }
    const int enough = cells_that_do(form, distance.function);
    return enough > 0 ? enough : form.sdf_cells;
}

int usual_cells(const scene::Shape& shape, const TemplateDistance& distance, ShapeTemplate& form)
{
    if (is_stone(shape)) { return stone_cells(shape, form); }
    const bool rim_or_file = std::holds_alternative<scene::WheelGenerator>(shape.source) ||
                             std::holds_alternative<scene::MeshFile>(shape.source);
    return rim_or_file ? wall_cells(*distance.mesh, form) : volume_cells(distance, form);
}

void warn_of_volume(const SignedDistance& distance, ShapeTemplate& form)
{
    if (std::abs(form.sdf_volume_ratio - 1) <= volume_tolerance) { return; }
    const int         enough = cells_that_do(form, distance);
    const std::string advice = enough > 0 ? fmt::format("sdf_cells = {} would be within 2 %", enough)
                                          : fmt::format("no sdf_cells up to {} is within 2 %", most_cells);
    form.warnings.push_back(fmt::format("its SDF of sdf_cells = {} encloses {:.1f} % of the mesh's volume; {}",
                                        form.sdf_cells, 100 * form.sdf_volume_ratio, advice));
}

} // namespace

int cells_for_wall(const Bounds& box, double thickness)
{
    constexpr double across = 1.5;
    const double     wanted = std::ceil(1.2 * box.extent().maxCoeff() * across / thickness);
    return static_cast<int>(std::clamp(wanted, double{least_cells}, 1e9));
}

TemplateDistance distance_of(const scene::Shape& shape, const Solid& solid)
{
    if (is_sphere(shape))
    {
        return {nullptr, [](const Eigen::Vector3d& point, double) { return point.norm() - 0.5; }};
    }
    if (solid.sign == SignRule::any_part)
    {
        const auto united = std::make_shared<const UnitedDistance>(prepare_united_distance(solid));
        const auto boundary =
            std::make_shared<const MeshDistance>(MeshDistance{SignRule::any_part, united->boundary, {}, {}});
        return {boundary, [united](const Eigen::Vector3d& point, double) { return signed_distance(*united, point); }};
    }
    auto prepared = std::make_shared<const MeshDistance>(prepare_distance(solid));
    return {prepared, [&of = *prepared](const Eigen::Vector3d& point, double within)
            { return signed_distance(of, point, within); }};
}

void add_sdf(const scene::Shape& shape, const TemplateDistance& distance, double reach, ShapeTemplate& form)
{
    form.sdf_cells        = shape.sdf_cells ? static_cast<int>(*shape.sdf_cells) : usual_cells(shape, distance, form);
    form.sdf              = build_sdf(bounds(form.mesh), form.sdf_cells, distance.function, reach);
    form.sdf_volume_ratio = enclosed_volume(form.sdf) / form.unit.volume;
    warn_of_volume(distance.function, form);
}

} // namespace tread::shape
