#pragma once

#include <memory>
#include <string>

#include "shape/distance/mesh_distance.hpp"
#include "shape/distance/sdf_grid.hpp"
#include "shape/solids/solid.hpp"
#include "shape/template.hpp"

// Signed distance field of a template: resolution and quality.
namespace tread::shape
{

/// Number of cells along the longest axis of the 120 % box for which 1.5 cells span a wall of `thickness` (m): a
/// thinner wall could fall between the nodes. At least 40 (the paper's particles, 2.1); no upper limit.
int cells_for_wall(const Bounds& box, double thickness);

/// Signed distance to a template's surface. Must outlive its function's calls.
struct TemplateDistance
{
    std::shared_ptr<const MeshDistance> mesh; ///< null for a generated sphere, whose distance is exact
    SignedDistance                      function;
};

TemplateDistance distance_of(const scene::Shape& shape, const Solid& solid);

/// A template with the distance that its field was sampled from.
struct MeasuredTemplate
{
    ShapeTemplate    form;
    TemplateDistance distance;
};

/// Runs make_template and returns the distance as well.
MeasuredTemplate make_measured_template(const scene::Shape& shape, const std::string& directory, const Reach& reach);

/// Fills sdf, sdf_cells, sdf_volume_ratio, and warnings about them, of a template with mesh and unit. The number of
/// cells is the shape's sdf_cells, or as its thinnest wall requires (at most 512), or as a stone's nodes require (40 to
/// 64). A tool or an assembly takes more than for its walls if they would lose over 2 % of its volume. If the volume is
/// off by more than 2 %, the warning names a sufficient number of cells, up to 512, found by trial.
void add_sdf(const scene::Shape& shape, const TemplateDistance& distance, double reach, ShapeTemplate& form);

} // namespace tread::shape
