#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/wait_note.hpp"

namespace tread
{

/// "rank 2", "ranks 1, 3".
std::string ranks_text(const std::vector<int>& ranks);

/// Detects that a rank waits too long or completes no step: a rank that waits for a message that never comes cannot
/// report it itself.
class Watchdog
{
public:
    /// Calls `bark`, once and in its own thread, with a sentence on what the rank waits for, when one of its `waits`
    /// has lasted for `timeout`, or when no step has ended for that long after begin_steps(). `absent` says who has not
    /// come to a collective call; empty: nobody knows.
    Watchdog(const WaitNote& waits, std::chrono::duration<double> timeout, std::function<void(const std::string&)> bark,
             std::function<std::string()> absent = {});
    ~Watchdog();
    Watchdog(const Watchdog&)            = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Expects steps from now on.
    void begin_steps();

    /// Records the end of a step; another follows.
    void advance();

    /// Expects no more steps.
    void end_steps();

private:
    using Clock = WaitNote::Clock;

    void                       watch();
    std::optional<std::string> complaint() const;

    const WaitNote&                         waits_;
    std::chrono::duration<double>           timeout_;
    std::function<void(const std::string&)> bark_;
    std::function<std::string()>            absent_;
    std::mutex                              mutex_;
    std::condition_variable                 changed_;
    std::optional<Clock::time_point>        last_; ///< end of the last step; empty: no step is expected
    std::int64_t                            steps_ = 0;
    bool                                    ended_ = false;
    std::thread                             thread_; ///< declared last, as it uses all of the above
};

} // namespace tread
