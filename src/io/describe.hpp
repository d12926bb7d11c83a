#pragma once

#include <string>

namespace tread::io
{

/// Describes the contents of an HDF5 file, one line per object: groups; data sets with shape, type and units; other
/// attributes. A child process reads it. InputError if the file does not exist, is not HDF5, or is too damaged for HDF5
/// to read.
std::string describe_file(const std::string& path);

/// Does so in this process, with EnvironmentError.
std::string describe_here(const std::string& path);

} // namespace tread::io
