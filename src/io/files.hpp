#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tread::io
{

/// Removes what has this name, if it is a file or a link: what is made there next is new, and no link leads elsewhere.
void remove_name(const std::string& path);

/// Replaces `path` with `text` in one step: a reader sees the old file or the new one, never a part. Links of these
/// names are replaced, not followed. EnvironmentError with the path and the reason.
void write_atomically(const std::string& path, const std::string& text);

/// The same; `before` runs once the text is on the disk and before it takes its place.
void write_atomically(const std::string& path, const std::string& text, const std::function<void()>& before);

/// Puts the finished file `from` in the place of `to`. EnvironmentError with the path and the reason.
void rename_file(const std::string& from, const std::string& to);

/// Puts `text` in the place of a file's first bytes; returns when all of the file is on the disk. EnvironmentError.
void overwrite_start(const std::string& path, const std::string& text);

/// Returns when a file's bytes, or the names in a directory, are on the disk. EnvironmentError.
void flush_to_disk(const std::string& path);

/// EnvironmentError unless a new file of so many bytes has room where `path` is: they are taken, and given back. Where
/// the file system cannot take them at once, what it says is free counts.
void require_space(const std::string& path, std::int64_t bytes);

/// Bytes that are free where `path` is, or would be. Unknown = all.
std::int64_t free_space(const std::string& path);

/// All bytes of a regular file. EnvironmentError.
std::string read_file(const std::string& path);

} // namespace tread::io
