#include "base/regular_file.hpp"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread
{

std::optional<std::string> irregularity(const std::string& path)
{
    namespace fs = std::filesystem;
    std::error_code error;
    const auto      type = fs::status(path, error).type();
    if (type == fs::file_type::regular) { return {}; }
    switch (type)
    {
    case fs::file_type::none:
    case fs::file_type::not_found:
        return error ? error.message() : "there is no such file";
    case fs::file_type::directory:
        return "it is a directory; accepted: a regular file";
    case fs::file_type::fifo:
        return "it is a pipe; accepted: a regular file";
    default:
        return "it is a device or a socket; accepted: a regular file";
    }
}

void require_regular(const std::string& path)
{
    if (const auto why = irregularity(path)) { throw EnvironmentError(fmt::format("{}: {}", path, *why)); }
}

} // namespace tread
