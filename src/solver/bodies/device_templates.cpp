#include "solver/bodies/device_templates.hpp"

#include <algorithm>

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"
#include "shape/distance/sdf_grid.hpp"
#include "solver/bodies/append.hpp"

namespace tread::solver
{
namespace
{

// Kernels do not include shape headers, but read their memory layout.
static_assert(dem::brick_cells == shape::SignedDistanceGrid::brick_cells);

/// Depth below the hull over the radius from which on a shape counts as concave: generated rocks of the default
/// solidity stay within 0.04, grousers exceed 0.07.
constexpr double concave_depth = 0.05;

dem::TemplateView measures(const shape::ShapeTemplate& form)
{
    dem::TemplateView view{};
    view.sdf.origin          = form.sdf.origin;
    view.sdf.spacing         = form.sdf.spacing;
    view.sdf.inverse_spacing = 1 / form.sdf.spacing;
    view.sdf.steepest        = shape::steepest_slope(form.sdf);
    view.sdf.nodes[0]        = form.sdf.nodes[0];
    view.sdf.nodes[1]        = form.sdf.nodes[1];
    view.sdf.nodes[2]        = form.sdf.nodes[2];
    view.sdf.bricks[0]       = form.sdf.bricks[0];
    view.sdf.bricks[1]       = form.sdf.bricks[1];
    view.sdf.bricks[2]       = form.sdf.bricks[2];
    view.sdf.fine_reach      = form.sdf.fine_reach;
    view.node_count          = static_cast<std::int32_t>(form.nodes.positions.size());
    view.part_count          = static_cast<std::int32_t>(form.nodes.part_centres.size());
    view.low                 = form.box.low;
    view.high                = form.box.high;
    view.bounding_radius     = form.bounding_radius;
    view.equivalent_radius   = form.equivalent_radius;
    view.sphere_radius       = form.sphere_radius;
    view.concave             = form.hull_depth > concave_depth * form.equivalent_radius;
    return view;
}

} // namespace

template<class Exec>
DeviceTemplates<Exec>::DeviceTemplates(const Exec& exec, const std::vector<shape::ShapeTemplate>& templates)
    : sdf_values_(exec, "template sdf")
    , sdf_slots_(exec, "template sdf bricks")
    , sdf_corners_(exec, "template sdf corners")
    , node_positions_(exec, "template nodes")
    , node_areas_(exec, "template node areas")
    , part_centres_(exec, "template node parts")
    , part_radii_(exec, "template part radii")
    , views_(exec, "templates")
{
    struct Start
    {
        std::size_t sdf, slot, corner, node, part;
    };
    std::vector<float>        sdf, corners;
    std::vector<std::int32_t> slots;
    std::vector<Vec3<double>> positions, centres;
    std::vector<double>       areas, radii;
    std::vector<Start>        starts;
    for (const auto& form : templates)
    {
        starts.push_back({append(sdf, form.sdf.values), append(slots, form.sdf.slots),
                          append(corners, form.sdf.corners), append(positions, form.nodes.positions),
                          append(centres, form.nodes.part_centres)});
        append(areas, form.nodes.areas);
        append(radii, form.nodes.part_radii);
    }
    sdf_values_.assign(sdf);
    sdf_slots_.assign(slots);
    sdf_corners_.assign(corners);
    node_positions_.assign(positions);
    node_areas_.assign(areas);
    part_centres_.assign(centres);
    part_radii_.assign(radii);

    std::vector<dem::TemplateView> views;
    views.reserve(templates.size());
    for (std::size_t t = 0; t < templates.size(); ++t)
    {
        dem::TemplateView view = measures(templates[t]);
        view.sdf.values        = sdf_values_.data() + starts[t].sdf;
        view.sdf.slots         = templates[t].sdf.slots.empty() ? nullptr : sdf_slots_.data() + starts[t].slot;
        view.sdf.corners       = sdf_corners_.data() + starts[t].corner;
        view.node_positions    = node_positions_.data() + starts[t].node;
        view.node_areas        = node_areas_.data() + starts[t].node;
        view.part_centres      = part_centres_.data() + starts[t].part;
        view.part_radii        = part_radii_.data() + starts[t].part;
        views.push_back(view);
    }
    views_.assign(views);
    concave_ = std::any_of(views.begin(), views.end(), [](const auto& view) { return view.concave; });
}

#define TREAD_INSTANTIATE(Exec) template class DeviceTemplates<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
