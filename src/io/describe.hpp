#pragma once

#include <string>

namespace tread::io
{

/// What an HDF5 file holds, one line an object: groups; data sets with shape, type and units; other attributes.
/// InputError when the file is not there, is not HDF5, or is damaged so that HDF5 cannot read it: that a copy of this
/// process tries.
std::string describe_file(const std::string& path);

/// The same by this process itself, with EnvironmentError.
std::string describe_here(const std::string& path);

} // namespace tread::io
