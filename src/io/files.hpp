#pragma once

#include <cstdint>
#include <string>

namespace tread::io
{

/// Replaces `path` with `text` in one step: a reader sees the old file or the new one, never a part.
/// EnvironmentError with the path and the reason.
void write_atomically(const std::string& path, const std::string& text);

/// Puts the finished file `from` in the place of `to`. EnvironmentError with the path and the reason.
void rename_file(const std::string& from, const std::string& to);

/// Puts `text` in the place of a file's first bytes; returns when all of the file is on the disk. EnvironmentError.
void overwrite_start(const std::string& path, const std::string& text);

/// Returns when a file's bytes, or the names in a directory, are on the disk. EnvironmentError.
void flush_to_disk(const std::string& path);

/// EnvironmentError unless a new file of so many bytes has room where `path` is: they are taken, and given back. Where
/// the file system cannot take them at once, what it says is free counts.
void require_space(const std::string& path, std::int64_t bytes);

/// All bytes of a regular file. EnvironmentError.
std::string read_file(const std::string& path);

} // namespace tread::io
