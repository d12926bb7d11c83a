#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

// Changes in a sound HDF5 file as a fuzzer's bytes ask for them: other values, exchanged ones, rows or data sets that
// lack or are too many, other attributes. The file stays one that HDF5 can bear, so that it may be read without a
// process of its own for each execution.
namespace tread::fuzz
{

/// Writes a copy of `original` with the edits of a fuzzer's bytes; the data set `left_alone` stays as it is.
void write_edited(const std::string& original, const std::string& copy, const std::uint8_t* data, std::size_t size,
                  const std::string& left_alone = "");

/// The folder that originals.py has filled: TREAD_FUZZ_ORIGINALS.
std::string originals();

} // namespace tread::fuzz
