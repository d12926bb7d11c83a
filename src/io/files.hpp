#pragma once

#include <string>

namespace tread::io
{

/// Replaces `path` with `text` in one step: a reader sees the old file or the new one, never a part.
/// EnvironmentError with the path and the reason.
void write_atomically(const std::string& path, const std::string& text);

/// Puts the finished file `from` in the place of `to`. EnvironmentError with the path and the reason.
void rename_file(const std::string& from, const std::string& to);

} // namespace tread::io
