#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tread
{

/// What a rank waits for in a message, kept where a watchdog's thread may look. One thread waits, others look.
class WaitNote
{
public:
    using Clock = std::chrono::steady_clock;

    struct Wait
    {
        std::string       what;  ///< "sum", "halo messages"
        std::vector<int>  ranks; ///< that it waits for; empty = all
        Clock::time_point since;
    };

    void                begin(const char* what, const std::vector<int>& ranks);
    void                end();
    std::optional<Wait> present() const;

private:
    mutable std::mutex mutex_;
    const char*        what_ = nullptr; ///< none: no wait
    std::vector<int>   ranks_;
    Clock::time_point  since_;
};

/// A wait while one lives; `what` outlives it.
class Waiting
{
public:
    Waiting(WaitNote& note, const char* what, const std::vector<int>& ranks = {})
        : note_(note)
    {
        note.begin(what, ranks);
    }
    ~Waiting() { note_.end(); }
    Waiting(const Waiting&)            = delete;
    Waiting& operator=(const Waiting&) = delete;

private:
    WaitNote& note_;
};

} // namespace tread
