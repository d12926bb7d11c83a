#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace tread
{

/// Notices that nothing has gone on for a while: a rank that waits for a message that never comes says nothing itself.
class Watchdog
{
public:
    /// Calls `bark`, once and in a thread of its own, when advance() was not called for `patience`.
    Watchdog(std::chrono::duration<double> patience, std::function<void()> bark);
    ~Watchdog();
    Watchdog(const Watchdog&)            = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    void advance();

private:
    using Clock = std::chrono::steady_clock;

    void watch();

    std::chrono::duration<double> patience_;
    std::function<void()>         bark_;
    std::mutex                    mutex_;
    std::condition_variable       changed_;
    Clock::time_point             last_;
    bool                          ended_ = false;
    std::thread                   thread_; ///< last: it uses all of the above
};

} // namespace tread
