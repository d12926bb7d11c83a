#pragma once

#include <string>
#include <vector>

#include "shape/distance/sdf_report.hpp"
#include "shape/template.hpp"

// Output of `tread sdf`.
namespace tread::shape
{

/// Describes geometry, mass properties, surface nodes and distance field, one per line.
std::string template_text(const ShapeTemplate& form);

/// Table with a line for each number of cells.
std::string convergence_text(const std::vector<SdfQuality>& qualities);

} // namespace tread::shape
