#include "base/signals.hpp"

#include <array>
#include <atomic>
#include <csignal>

namespace tread
{
namespace
{

struct Watched
{
    int         number;
    const char* name;
};

constexpr std::array<Watched, 4> watched{{{SIGUSR1, "USR1"}, {SIGUSR2, "USR2"}, {SIGTERM, "TERM"}, {SIGINT, "INT"}}};

// Lock-free atomics are all that a signal handler may touch (POSIX, async-signal-safe).
std::atomic<bool> checkpoint_asked{false}, stop_asked{false};
std::atomic<int>  last{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void note(int number)
{
    last = number;
    if (number == SIGUSR1)
    {
        checkpoint_asked = true;
        return;
    }
    stop_asked = true;
    if (number == SIGINT) { std::signal(SIGINT, SIG_DFL); }
}

} // namespace

SignalWatch::SignalWatch()
{
    checkpoint_asked = false;
    stop_asked       = false;
    last             = 0;
    for (const Watched& signal : watched)
    {
        struct sigaction action = {};
        action.sa_handler       = note;
        action.sa_flags         = SA_RESTART; // interrupted writes continue
        sigemptyset(&action.sa_mask);
        sigaction(signal.number, &action, nullptr);
    }
}

SignalWatch::~SignalWatch()
{
    for (const Watched& signal : watched) { std::signal(signal.number, SIG_DFL); }
}

Request SignalWatch::take()
{
    const bool checkpoint = checkpoint_asked.exchange(false);
    if (stop_asked) { return Request::stop; }
    return checkpoint ? Request::checkpoint : Request::none;
}

bool SignalWatch::stop_is_asked() { return stop_asked; }

const char* SignalWatch::last_name()
{
    for (const Watched& signal : watched)
    {
        if (signal.number == last) { return signal.name; }
    }
    return "";
}

} // namespace tread
