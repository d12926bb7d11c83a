#pragma once

#include <memory>
#include <string>

#include "shape/mesh_distance.hpp"
#include "shape/sdf_grid.hpp"
#include "shape/solid.hpp"
#include "shape/template.hpp"

// The signed distance field of a template: how fine, how good.
namespace tread::shape
{

/// Cells along the longest axis of the 120 % box so that 1.5 of them stand across a wall of `thickness` (m): thinner,
/// and the wall falls between the nodes. 40 (the paper's particles, 2.1) at least; not bounded above.
int cells_for_wall(const Bounds& box, double thickness);

/// The signed distance of a template's surface. Keep it while its function is called.
struct TemplateDistance
{
    std::shared_ptr<const MeshDistance> mesh; ///< null for a generated sphere, which is the exact one
    SignedDistance                      function;
};

TemplateDistance distance_of(const scene::Shape& shape, const Solid& solid);

/// A template with what its field was sampled from.
struct MeasuredTemplate
{
    ShapeTemplate    form;
    TemplateDistance distance;
};

/// make_template, with the distance.
MeasuredTemplate make_measured_template(const scene::Shape& shape, const std::string& directory, const Reach& reach);

/// Fills sdf, sdf_cells, sdf_volume_ratio, and warnings about them, of a template whose mesh and unit are made: the
/// shape's sdf_cells, or as many as its thinnest wall wants (at most 512), or as a stone's nodes want (40 to 64). Where
/// the volume is off by more than 2 %, the warning names the cells that would do, up to 512, found by trying.
void add_sdf(const scene::Shape& shape, const TemplateDistance& distance, double reach, ShapeTemplate& form);

} // namespace tread::shape
