#include "base/watchdog.hpp"

#include <utility>

namespace tread
{

Watchdog::Watchdog(std::chrono::duration<double> patience, std::function<void()> bark)
    : patience_(patience)
    , bark_(std::move(bark))
    , last_(Clock::now())
    , thread_([this] { watch(); })
{
}

Watchdog::~Watchdog()
{
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Watchdog::advance()
{
    const std::lock_guard<std::mutex> lock(mutex_);
    last_ = Clock::now();
}

void Watchdog::watch()
{
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_)
    {
        const auto due = last_ + std::chrono::duration_cast<Clock::duration>(patience_);
        if (Clock::now() >= due)
        {
            bark_();
            return;
        }
        changed_.wait_until(lock, due);
    }
}

} // namespace tread
