#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tread
{

/// The message that a rank waits for, readable by a watchdog's thread. One thread waits, others read.
class WaitNote
{
public:
    using Clock = std::chrono::steady_clock;

    struct Wait
    {
        std::string       what;  ///< "sum", "halo messages"
        std::vector<int>  ranks; ///< ranks waited for; empty in a collective call
        Clock::time_point since;
    };

    void begin(const char* what, const std::vector<int>& ranks);
    void begin_collective(const char* what);
    void end();

    /// Counts collective calls from now on there as well; null: no more.
    void count_collectives(std::atomic<std::int64_t>* count) { collectives_ = count; }

    std::optional<Wait> present() const;

private:
    mutable std::mutex mutex_;
    const char*        what_ = nullptr; ///< null while not waiting
    std::vector<int>   ranks_;
    Clock::time_point  since_;

    std::atomic<std::int64_t>* collectives_ = nullptr;
};

/// Marks a wait for all ranks, in a collective call, or for some during its lifetime; `what` must outlive it.
class Waiting
{
public:
    Waiting(WaitNote& note, const char* what)
        : note_(note)
    {
        note.begin_collective(what);
    }
    Waiting(WaitNote& note, const char* what, const std::vector<int>& ranks)
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
