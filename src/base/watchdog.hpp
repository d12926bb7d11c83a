#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/wait_note.hpp"

namespace tread
{

/// Notices that a rank waits too long, or takes no step: a rank that waits for a message that never comes says nothing
/// itself.
class Watchdog
{
public:
    /// Calls `bark`, once and in a thread of its own, with a sentence that says what the rank waits for, when one of
    /// its `waits` has lasted for `timeout`, or its steps have begun and none ended for so long.
    Watchdog(const WaitNote& waits, std::chrono::duration<double> timeout,
             std::function<void(const std::string&)> bark);
    ~Watchdog();
    Watchdog(const Watchdog&)            = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// From now on a step is due.
    void begin_steps();

    /// A step has ended, and another follows.
    void advance();

    /// No more steps are to come.
    void end_steps();

private:
    using Clock = WaitNote::Clock;

    void                       watch();
    std::optional<std::string> complaint() const;

    const WaitNote&                         waits_;
    std::chrono::duration<double>           timeout_;
    std::function<void(const std::string&)> bark_;
    std::mutex                              mutex_;
    std::condition_variable                 changed_;
    std::optional<Clock::time_point>        last_; ///< end of a step; none: no step is due
    std::int64_t                            steps_ = 0;
    bool                                    ended_ = false;
    std::thread                             thread_; ///< last: it uses all of the above
};

} // namespace tread
