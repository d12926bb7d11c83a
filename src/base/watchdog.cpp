#include "base/watchdog.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tread
{
namespace
{

using Seconds = std::chrono::duration<double>;

constexpr Seconds longest_nap{1};

std::string wait_text(const WaitNote::Wait& wait, Seconds passed, const std::function<std::string()>& absent)
{
    const bool  collective = wait.ranks.empty();
    std::string text       = fmt::format("has waited {:.3g} s for {} ({})", passed.count(),
                                   collective ? "all ranks" : ranks_text(wait.ranks), wait.what);
    return collective && absent ? text + ", " + absent() : text;
}

} // namespace

std::string ranks_text(const std::vector<int>& ranks)
{
    return fmt::format("{} {}", ranks.size() == 1 ? "rank" : "ranks", fmt::join(ranks, ", "));
}

Watchdog::Watchdog(const WaitNote& waits, Seconds timeout, std::function<void(const std::string&)> bark,
                   std::function<std::string()> absent)
    : waits_(waits)
    , timeout_(timeout)
    , bark_(std::move(bark))
    , absent_(std::move(absent))
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

void Watchdog::begin_steps()
{
    const std::lock_guard<std::mutex> lock(mutex_);
    last_ = Clock::now();
}

void Watchdog::advance()
{
    const std::lock_guard<std::mutex> lock(mutex_);
    last_ = Clock::now();
    ++steps_;
}

void Watchdog::end_steps()
{
    const std::lock_guard<std::mutex> lock(mutex_);
    last_.reset();
}

/// Describes an overdue wait or step; empty if there is none. The caller holds the mutex.
std::optional<std::string> Watchdog::complaint() const
{
    const Clock::time_point             now    = Clock::now();
    const std::optional<WaitNote::Wait> wait   = waits_.present();
    const Seconds                       waited = wait ? now - wait->since : Seconds(0);
    const Seconds                       idle   = last_ ? now - *last_ : Seconds(0);
    if (waited < timeout_ && idle < timeout_) { return std::nullopt; }
    const std::string what =
        wait ? wait_text(*wait, waited, absent_)
             : fmt::format("has ended no step for {:.3g} s and waits for no message: it computes, or waits for a file, "
                           "for NCCL or for its GPU",
                           idle.count());
    return fmt::format("{}, after {} steps of this run", what, steps_);
}

void Watchdog::watch()
{
    const auto                   nap = std::chrono::duration_cast<Clock::duration>(std::min(longest_nap, timeout_ / 4));
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_)
    {
        if (const auto found = complaint())
        {
            lock.unlock();
            bark_(*found);
            return;
        }
        changed_.wait_for(lock, nap);
    }
}

} // namespace tread
