#pragma once

#include <string>
#include <vector>

#include "shape/sdf_report.hpp"
#include "shape/template.hpp"

// What `tread sdf` prints.
namespace tread::shape
{

/// Geometry, mass properties, surface nodes and distance field, a line each.
std::string template_text(const ShapeTemplate& form);

/// A table, a line a number of cells.
std::string convergence_text(const std::vector<SdfQuality>& qualities);

} // namespace tread::shape
