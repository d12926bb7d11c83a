#pragma once

#include <cstdint>
#include <string>

#include "base/communicator.hpp"

namespace tread::io
{

/// Collective: of the bytes of a file from `first` to `end`, each rank reading a share of them. In blocks of 4 MiB,
/// FNV-1a by words of 64 bits; the checksum is that of the blocks' own. A word that differs changes it for certain, as
/// each step maps different words, and different sums, to different sums. EnvironmentError when the file cannot be
/// read that far.
std::uint64_t checksum(const Communicator& communicator, const std::string& path, std::int64_t first, std::int64_t end);

} // namespace tread::io
