#include "solver/bodies/device_rays.hpp"

#include <cstddef>

#include "backend/instantiate.hpp"
#include "shape/flat_tree.hpp"
#include "solver/bodies/append.hpp"

namespace tread::solver
{
dem::RayShape ray_shape(const shape::ShapeTemplate& form)
{
    const shape::TriangleTree tree = shape::build_tree(form.mesh);
    return dem::make_ray_shape(shape::flatten(tree), form.nodes.positions,
                               shape::surface_normals(form.mesh, tree, form.nodes.positions));
}

template<class Exec>
DeviceRays<Exec>::DeviceRays(const Exec& exec, const std::vector<shape::ShapeTemplate>& templates)
    : boxes_(exec, "template boxes")
    , triangles_(exec, "template triangles")
    , inward_(exec, "template node normals")
    , length_(exec, "template ray lengths")
    , views_(exec, "template rays")
{
    struct Start
    {
        std::size_t box, triangle, node;
    };
    dem::RayShape             all;
    std::vector<Start>        starts;
    std::vector<dem::RayView> views;
    for (const auto& form : templates)
    {
        const dem::RayShape own = ray_shape(form);
        starts.push_back(
            {append(all.boxes, own.boxes), append(all.triangles, own.triangles), append(all.inward, own.inward)});
        append(all.length, own.length);
        views.push_back(own.view());
    }
    if (templates.empty()) { return; }
    boxes_.assign(all.boxes);
    triangles_.assign(all.triangles);
    inward_.assign(all.inward);
    length_.assign(all.length);
    for (std::size_t t = 0; t < views.size(); ++t)
    {
        views[t].boxes     = boxes_.data() + starts[t].box;
        views[t].triangles = triangles_.data() + starts[t].triangle;
        views[t].inward    = inward_.data() + starts[t].node;
        views[t].length    = length_.data() + starts[t].node;
    }
    views_.assign(views);
}

#define TREAD_INSTANTIATE(Exec) template class DeviceRays<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
