#pragma once

#include <cstddef>
#include <vector>

#include "shape/template_sdf.hpp"

// How a template's signed distance field converges with its cells: the paper's Fig. 3 (2.1), and the normals.
namespace tread::shape
{

/// The field with so many cells along the longest axis, against the surface that it is made from. The paper does not
/// say what normalises its surface error; here it is the longest extent of the shape.
struct SdfQuality
{
    int         cells;
    double      mean_surface;  ///< |phi| at points spread evenly on the surface over the extent, mean
    double      worst_surface; ///< largest
    double      volume_ratio;  ///< enclosed volume over the mesh's
    double      mean_normal;   ///< degrees at those points, of the gradient to the face's normal
    double      worst_normal;
    double      seconds; ///< to build it
    std::size_t bytes;
};

/// 10 to 200, as in the paper's figure.
std::vector<int> report_cells();

/// Builds and measures a field for each number of `cells`.
std::vector<SdfQuality> sdf_convergence(const MeasuredTemplate& measured, const std::vector<int>& cells);

} // namespace tread::shape
