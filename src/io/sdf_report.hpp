#pragma once

#include <string>
#include <vector>

#include "shape/distance/sdf_report.hpp"

namespace tread::io
{

/// Writes a new HDF5 file, or truncates one: attributes `shape` and `extent` (m) and a data set for each member of
/// SdfQuality. Throws EnvironmentError that names the file.
void write_sdf_report(const std::string& path, const shape::ShapeTemplate& form,
                      const std::vector<shape::SdfQuality>& qualities);

} // namespace tread::io
