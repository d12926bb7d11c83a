#include "base/log.hpp"

#include <iostream>

#include <fmt/format.h>

namespace tread
{

Log::Log(const Communicator& communicator, Terminal terminal)
    : speaks_(communicator.rank() == 0)
    , terminal_(terminal)
{
}

void Log::info(std::string_view line)
{
    if (!speaks_) { return; }
    if (terminal_ == Terminal::shown) { std::cout << line << std::endl; }
    keep(std::string(line));
}

void Log::warning(std::string_view line)
{
    if (!speaks_) { return; }
    std::string marked = fmt::format("warning: {}", line);
    if (terminal_ == Terminal::shown) { std::cerr << marked << std::endl; }
    keep(std::move(marked));
}

void Log::open(const std::string& path, LogFile file)
{
    if (!speaks_) { return; }
    path_ = path;
    file_.open(path, file == LogFile::anew ? std::ios::out : std::ios::app);
    for (std::string& line : early_) { keep(std::move(line)); }
    early_.clear();
}

void Log::keep(std::string line)
{
    if (path_.empty())
    {
        early_.push_back(std::move(line));
        return;
    }
    file_ << line << std::endl;
    if (!file_) { throw EnvironmentError(fmt::format("{}: the log cannot be written", path_)); }
}

} // namespace tread
