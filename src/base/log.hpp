#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/communicator.hpp"
#include "base/terminal.hpp"

namespace tread
{

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
    ~Log();
    Log(const Log&)            = delete;
    Log& operator=(const Log&) = delete;

    /// Writes to standard output.
    void info(std::string_view line);

    /// Writes to the file, and to a terminal that shows no status.
    void progress(std::string_view line);

    /// Shows the status below all lines of a live terminal, in place of the one before; nowhere else. The next line
    /// removes it.
    void status(std::string_view line);

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
    void remove_status();

    bool                     speaks_;
    Terminal                 terminal_;
    bool                     has_status_ = false; ///< a status is on the terminal
    std::string              path_;
    File                     file_;
    std::vector<std::string> early_; ///< lines logged before a file was open
};

} // namespace tread
