#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tread::io
{

/// Removes a file or link of this name, so that what is created there next is new and follows no link.
void remove_name(const std::string& path);

/// Replaces `path` with `text` atomically: a reader sees the old file or the new one, never a part. Links of this name
/// are replaced, not followed. EnvironmentError with the path and the reason.
void write_atomically(const std::string& path, const std::string& text);

/// Writes the file in the same way, and calls `before` when the text is on the disk and not yet renamed.
void write_atomically(const std::string& path, const std::string& text, const std::function<void()>& before);

/// Renames the finished file `from` to `to`. EnvironmentError with the path and the reason.
void rename_file(const std::string& from, const std::string& to);

/// Overwrites the first bytes of a file with `text`; returns when the whole file is on the disk. EnvironmentError.
void overwrite_start(const std::string& path, const std::string& text);

/// Flushes a file, or the names in a directory, to disk. EnvironmentError.
void flush_to_disk(const std::string& path);

/// EnvironmentError unless a new file of `bytes` fits where `path` is: the space is allocated and released again. If
/// the file system cannot allocate it, the reported free space decides.
void require_space(const std::string& path, std::int64_t bytes);

/// Free bytes where `path` is, or would be. All, if unknown.
std::int64_t free_space(const std::string& path);

/// Reads all bytes of a regular file. EnvironmentError.
std::string read_file(const std::string& path);

} // namespace tread::io
