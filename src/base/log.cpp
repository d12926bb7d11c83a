#include "base/log.hpp"

#include <iostream>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/printable.hpp"

namespace tread
{

Log::Log(const Communicator& communicator, Terminal terminal)
    : speaks_(communicator.rank() == 0)
    , terminal_(terminal)
{
}

Log::~Log() { remove_status(); }

void Log::info(std::string_view line)
{
    if (!speaks_) { return; }
    std::string shown = printable(line);
    remove_status();
    if (terminal_ != Terminal::silent) { std::cout << shown << std::endl; }
    keep(std::move(shown));
}

void Log::progress(std::string_view line)
{
    if (terminal_ != Terminal::live) { info(line); }
    else if (speaks_) { keep(printable(line)); }
}

void Log::status(std::string_view line)
{
    if (!speaks_ || terminal_ != Terminal::live) { return; }
    remove_status();
    std::cout << printable(line) << std::flush;
    has_status_ = true;
}

void Log::remove_status()
{
    if (!has_status_) { return; }
    std::cout << "\r\x1b[K" << std::flush; // ECMA-48: to the first column, erase in line
    has_status_ = false;
}

void Log::warning(std::string_view line)
{
    if (!speaks_) { return; }
    std::string marked = fmt::format("warning: {}", printable(line));
    remove_status();
    if (terminal_ != Terminal::silent) { std::cerr << marked << std::endl; }
    keep(std::move(marked));
}

void Log::open(const std::string& path, LogFile file)
{
    if (!speaks_) { return; }
    path_ = path;
    file_ = open_file(path, file);
    for (std::string& line : early_) { keep(std::move(line)); }
    early_.clear();
}

/// Null on failure.
Log::File Log::open_file(const std::string& path, LogFile file)
{
    const int flags      = O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | (file == LogFile::anew ? O_EXCL : O_APPEND);
    const int descriptor = ::open(path.c_str(), flags, 0644);
    return File(descriptor < 0 ? nullptr : fdopen(descriptor, file == LogFile::anew ? "w" : "a"));
}

void Log::keep(std::string line)
{
    if (path_.empty())
    {
        early_.push_back(std::move(line));
        return;
    }
    const bool written = file_ && std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size() &&
                         std::fputc('\n', file_.get()) != EOF && std::fflush(file_.get()) == 0;
    if (!written) { throw EnvironmentError(fmt::format("{}: the log cannot be written", path_)); }
}

} // namespace tread
