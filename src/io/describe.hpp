#pragma once

#include <string>

namespace tread::io
{

/// What an HDF5 file holds, one line an object: groups; data sets with shape, type and units; other attributes.
/// InputError when the file is not there or is not HDF5.
std::string describe_file(const std::string& path);

} // namespace tread::io
