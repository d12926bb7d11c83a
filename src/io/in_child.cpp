#include "io/in_child.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.hpp"

namespace tread::io
{
namespace
{

constexpr int said_an_error = 1; ///< exit code of a child whose text is an error message

/// Bytes of address space of this process.
std::int64_t address_space()
{
    std::ifstream pages_of("/proc/self/statm");
    std::int64_t  pages = 0;
    pages_of >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

void limit(int resource, std::int64_t most)
{
    rlimit wanted{};
    if (getrlimit(resource, &wanted) != 0) { return; }
    const auto value = static_cast<rlim_t>(most);
    if (wanted.rlim_max == RLIM_INFINITY || value < wanted.rlim_max) { wanted.rlim_cur = wanted.rlim_max = value; }
    setrlimit(resource, &wanted);
}

void write_all(int to, std::string_view text)
{
    while (!text.empty())
    {
        const ssize_t written = write(to, text.data(), text.size());
        if (written < 0 && errno == EINTR) { continue; }
        if (written <= 0) { return; }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

/// Does not return: the child must not run this process's exit handlers.
[[noreturn]] void be_child(int to, const std::function<std::string()>& work, const ChildLimits& limits)
{
    for (const int number : {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGUSR1, SIGUSR2})
    {
        std::signal(number, SIG_DFL);
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, limits.busy);
    limit(RLIMIT_AS, address_space() + limits.bytes);
    int code = 0;
    try
    {
        write_all(to, work());
    }
    catch (const std::exception& error)
    {
        write_all(to, error.what());
        code = said_an_error;
    }
    _exit(code);
}

/// Reads what the child writes until it ends; false if it exceeds the time or the size limit.
bool read_all(int from, std::string& text, const ChildLimits& limits)
{
    using Clock           = std::chrono::steady_clock;
    const auto        end = Clock::now() + std::chrono::seconds(limits.wall);
    std::vector<char> part(std::size_t{1} << 16);
    while (text.size() <= limits.text)
    {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd     wait{from, POLLIN, 0};
        const int  ready = left > 0 ? poll(&wait, 1, static_cast<int>(left)) : 0;
        if (ready < 0 && errno == EINTR) { continue; }
        if (ready <= 0) { return false; }
        const ssize_t got = read(from, part.data(), part.size());
        if (got < 0 && errno == EINTR) { continue; }
        if (got <= 0) { return got == 0; }
        text.append(part.data(), static_cast<std::size_t>(got));
    }
    return false;
}

int wait_for(pid_t child)
{
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    return status;
}

} // namespace

std::string run_in_child(const std::string& what, const std::function<std::string()>& work, const ChildLimits& limits)
{
    int ends[2];
    if (pipe(ends) != 0) { throw EnvironmentError(fmt::format("{}: no pipe: {}", what, std::strerror(errno))); }
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
    {
        const int reason = errno;
        close(ends[0]);
        close(ends[1]);
        throw EnvironmentError(fmt::format("{}: no process for it: {}", what, std::strerror(reason)));
    }
    if (child == 0)
    {
        close(ends[0]);
        be_child(ends[1], work, limits);
    }
    close(ends[1]);
    std::string text;
    const bool  ended = read_all(ends[0], text, limits);
    close(ends[0]);
    if (!ended) { kill(child, SIGKILL); }
    const int status = wait_for(child);
    if (!ended) { throw EnvironmentError(fmt::format("{}: takes too long or too much; the file is damaged", what)); }
    if (WIFSIGNALED(status))
    {
        throw EnvironmentError(
            fmt::format("{}: HDF5 cannot bear it (signal {}); the file is damaged", what, WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != 0) { throw EnvironmentError(text); }
    return text;
}

} // namespace tread::io
