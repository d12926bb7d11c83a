#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tread::world
{

/// Heights on a rectangular lattice.
struct Raster
{
    std::size_t         columns = 0; ///< along x
    std::size_t         rows    = 0;
    std::vector<double> heights; ///< m, row by row, the first row at high y
};

/// Reads a PGM (P2 or P5, 8 or 16 bits; black is `low`, white is `high`) or a CSV (numbers separated by commas, in
/// `unit`; empty lines and lines that begin with # are skipped). At least 2 x 2 and at most 1e8 samples. Throws
/// InputError with the file and, where it applies, the line.
Raster read_raster(const scene::RasterFile& file);

/// Interpolates the height at (x, y) between the four samples around it; the outermost samples lie on the extent. NaN
/// beyond the extent (by more than rounding).
double bilinear(const Raster& raster, const scene::PlanExtent& extent, double x, double y);

} // namespace tread::world
