#pragma once

#include <string>
#include <vector>

#include "io/h5.hpp"

namespace tread::io
{

/// Origin of a file.
struct Provenance
{
    std::string              scene_hash;
    std::string              backend;
    std::vector<std::string> devices; ///< GPUs; empty on the CPU
    int                      ranks = 1;
    std::string              start; ///< when the run began, UTC, ISO 8601
};

/// Present time, as "2026-11-22T14:41:28Z".
std::string utc_now();

/// Writes the provenance as attributes of the root, with version and commit of the code and the time of writing.
void write_provenance(const h5::File& file, const Provenance& provenance, const std::string& written = utc_now());

/// Sets `written` to the present time.
void stamp_written(const h5::File& file);

} // namespace tread::io
