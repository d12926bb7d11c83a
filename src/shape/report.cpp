#include "shape/report.hpp"

#include <fmt/format.h>

#include "shape/generators/form.hpp"

namespace tread::shape
{
namespace
{

constexpr double mebibyte = 1024.0 * 1024.0;

std::string vector_text(const Eigen::Vector3d& vector)
{
    return fmt::format("{:.6g} {:.6g} {:.6g}", vector.x(), vector.y(), vector.z());
}

/// "all of them exact", or the number of fine bricks.
std::string storage_text(const SignedDistanceGrid& sdf)
{
    constexpr std::size_t n = SignedDistanceGrid::brick_nodes;
    if (sdf.slots.empty()) { return "dense"; }
    return fmt::format("{} of {} bricks fine", sdf.values.size() / (n * n * n), sdf.slots.size());
}

std::string sign_text(SignRule sign)
{
    switch (sign)
    {
    case SignRule::pseudonormal:
        return "yes";
    case SignRule::winding_number:
        return "no, signed by winding number";
    default:
        return "each part, of whose union this is the boundary";
    }
}

} // namespace

std::string template_text(const ShapeTemplate& form)
{
    double area = 0;
    for (const double part : form.nodes.areas) { area += part; }
    const auto& nodes = form.sdf.nodes;

    std::string text = fmt::format("shape           {}\n", form.name);
    text += fmt::format("watertight      {}: {} vertices, {} triangles\n", sign_text(form.sign),
                        form.mesh.vertices.size(), form.mesh.triangles.size());
    for (const std::string& remark : form.remarks) { text += fmt::format("remark          {}\n", remark); }
    text += fmt::format("extent          {} m\n", vector_text(form.box.extent()));
    text += fmt::format("centre of mass  {} m\n", vector_text(form.mesh_centre));
    text += fmt::format("volume          {:.6g} m3\n", form.unit.volume);
    text += fmt::format("area            {:.6g} m2\n", area);
    for (Eigen::Index row = 0; row < 3; ++row)
    {
        text += fmt::format("{:<15} {} m5\n", row == 0 ? "inertia (1)" : "",
                            vector_text(form.unit.inertia.row(row).transpose()));
    }
    text += fmt::format("surface nodes   {}, {:.4g} m apart\n", form.nodes.positions.size(), form.nodes.spacing);
    text += fmt::format("SDF             sdf_cells = {}: {} x {} x {} nodes, {:.4g} m apart, {}, {:.1f} MiB\n",
                        form.sdf_cells, nodes[0], nodes[1], nodes[2], form.sdf.spacing, storage_text(form.sdf),
                        static_cast<double>(form.sdf.bytes()) / mebibyte);
    text += fmt::format("SDF volume      {:.4f} of the mesh's\n", form.sdf_volume_ratio);
    text += form_table({{"form (2)", form_of(form.mesh)}});
    text += "(1) about the centre of mass, mesh axes, density 1 kg/m3\n";
    text += "(2) by callipers, surface and convex hull: docs/shapes.md\n";
    return text;
}

std::string convergence_text(const std::vector<SdfQuality>& qualities)
{
    std::string text = "cells  |phi|/extent: mean      max  volume  normal: mean     max  seconds      MiB\n";
    for (const SdfQuality& q : qualities)
    {
        text += fmt::format("{:>5}  {:>18.2e} {:>8.2e} {:>7.4f} {:>11.2f} deg {:>5.1f} {:>8.3f} {:>8.2f}\n", q.cells,
                            q.mean_surface, q.worst_surface, q.volume_ratio, q.mean_normal, q.worst_normal, q.seconds,
                            static_cast<double>(q.bytes) / mebibyte);
    }
    return text;
}

} // namespace tread::shape
