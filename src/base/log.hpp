#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/communicator.hpp"

namespace tread
{

enum class Terminal
{
    shown,
    silent
};

enum class LogFile
{
    anew,
    continued
};

/// Log of a run: writes printable lines to rank 0's terminal, and to a file once one is open. Other ranks write
/// nothing.
class Log
{
public:
    Log(const Communicator& communicator, Terminal terminal);

    /// Writes to standard output.
    void info(std::string_view line);

    /// Writes to standard error, marked "warning: ".
    void warning(std::string_view line);

    /// Creates the file at `path`, which must not exist, or appends to it, beginning with all lines logged so far.
    /// EnvironmentError, here and in the calls above, if it cannot be written or is a link.
    void open(const std::string& path, LogFile file = LogFile::anew);

private:
    struct Close
    {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    using File = std::unique_ptr<std::FILE, Close>;

    static File open_file(const std::string& path, LogFile file);

    void keep(std::string line);

    bool                     speaks_;
    Terminal                 terminal_;
    std::string              path_;
    File                     file_;
    std::vector<std::string> early_; ///< lines logged before a file was open
};

} // namespace tread
