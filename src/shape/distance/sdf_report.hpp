#pragma once

#include <cstddef>
#include <vector>

#include "shape/distance/template_sdf.hpp"

// Convergence of a template's signed distance field with its number of cells: the paper's Fig. 3 (2.1), and normals.
namespace tread::shape
{

/// Errors of the field with one number of cells along the longest axis, relative to the surface that it is built from.
/// The paper does not state how its surface error is normalised; here it is by the longest extent of the shape.
struct SdfQuality
{
    int         cells;
    double      mean_surface;  ///< |phi| over the extent at points evenly distributed over the surface, mean
    double      worst_surface; ///< maximum
    double      volume_ratio;  ///< enclosed volume over the mesh's
    double      mean_normal;   ///< degrees at those points, between the gradient and the face's normal
    double      worst_normal;
    double      seconds; ///< to build the field
    std::size_t bytes;
};

/// Numbers of cells from 10 to 200, as in the paper's figure.
std::vector<int> report_cells();

/// Builds and measures a field for each number of `cells`.
std::vector<SdfQuality> sdf_convergence(const MeasuredTemplate& measured, const std::vector<int>& cells);

} // namespace tread::shape
