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

/// What a run says: lines to rank 0's terminal, and to a file from the moment that there is one, both printable. Other
/// ranks are mute.
class Log
{
public:
    Log(const Communicator& communicator, Terminal terminal);

    /// To standard output.
    void info(std::string_view line);

    /// To standard error, marked "warning: ".
    void warning(std::string_view line);

    /// Starts the file at `path`, which must not be there, or goes on at its end, with every line said so far.
    /// EnvironmentError when it cannot be written, here and in the calls above, or is a link.
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
    std::vector<std::string> early_; ///< lines said before there was a file
};

} // namespace tread
