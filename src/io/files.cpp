#include "io/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/errors.hpp"
#include "base/regular_file.hpp"

namespace tread::io
{

namespace
{

[[noreturn]] void fail(const std::string& path)
{
    throw EnvironmentError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

struct Close
{
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Creates a new file and returns its descriptor; negative on failure.
int open_new(const std::string& path)
{
    remove_name(path);
    return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
}

} // namespace

void remove_name(const std::string& path) { unlink(path.c_str()); }

void write_atomically(const std::string& path, const std::string& text)
{
    write_atomically(path, text, [] {});
}

void write_atomically(const std::string& path, const std::string& text, const std::function<void()>& before)
{
    const std::string temporary = path + ".tmp";

    const int descriptor = open_new(temporary);
    if (descriptor < 0) { fail(path); }
    std::unique_ptr<std::FILE, Close> file(fdopen(descriptor, "w"));
    if (!file) { fail(path); }
    const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size() &&
                         std::fflush(file.get()) == 0 && fsync(fileno(file.get())) == 0;
    if (!written)
    {
        const int reason = errno;
        std::remove(temporary.c_str());
        errno = reason;
        fail(path);
    }
    file.reset();
    before();
    rename_file(temporary, path);
}

void rename_file(const std::string& from, const std::string& to)
{
    if (std::rename(from.c_str(), to.c_str()) != 0) { fail(to); }
}

void overwrite_start(const std::string& path, const std::string& text)
{
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "r+"));
    if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0 ||
        fsync(fileno(file.get())) != 0)
    {
        fail(path);
    }
}

void flush_to_disk(const std::string& path)
{
    const int  file    = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const bool flushed = file >= 0 && fsync(file) == 0;
    const int  reason  = errno;
    if (file >= 0) { close(file); }
    errno = reason;
    if (!flushed) { fail(path); }
}

void require_space(const std::string& path, std::int64_t bytes)
{
    const std::string probe = path + ".room.tmp";
    const int         file  = open_new(probe);
    if (file < 0) { fail(path); }
    int            reason = fallocate(file, 0, 0, std::max<std::int64_t>(bytes, 1)) == 0 ? 0 : errno;
    struct statvfs disk   = {};
    if (reason == EOPNOTSUPP && fstatvfs(file, &disk) == 0)
    {
        reason = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) < static_cast<double>(bytes)
                     ? ENOSPC
                     : 0;
    }
    close(file);
    std::remove(probe.c_str());
    errno = reason;
    if (reason != 0) { fail(path); }
}

std::int64_t free_space(const std::string& path)
{
    std::error_code       none;
    std::filesystem::path place = std::filesystem::absolute(path, none);
    while (!std::filesystem::exists(place, none) && place.has_relative_path()) { place = place.parent_path(); }
    const std::filesystem::space_info space = std::filesystem::space(place, none);
    return none ? std::numeric_limits<std::int64_t>::max() : static_cast<std::int64_t>(space.available);
}

std::string read_file(const std::string& path)
{
    require_regular(path);
    std::ifstream file(path, std::ios::binary);
    std::string   bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!file) { throw EnvironmentError(fmt::format("{}: cannot be read", path)); }
    return bytes;
}

} // namespace tread::io
