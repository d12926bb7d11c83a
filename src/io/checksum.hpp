#pragma once

#include <cstdint>
#include <string>

#include "base/communicator.hpp"

namespace tread::io
{

/// Computes the checksum of a file's bytes from `first` to `end`. Collective: each rank reads a share. FNV-1a over
/// 64-bit words, in blocks of 4 MiB, and again over the blocks' checksums. A single changed word always changes it,
/// because each step is injective in the word and in the sum. EnvironmentError if the file cannot be read that far.
std::uint64_t checksum(const Communicator& communicator, const std::string& path, std::int64_t first, std::int64_t end);

} // namespace tread::io
