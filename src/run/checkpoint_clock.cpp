#include "run/checkpoint_clock.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include <fmt/format.h>

#include "base/signals.hpp"

namespace tread::run
{
namespace
{

constexpr double least_margin = 1; ///< s before the limit, for writing the summary and ending the process

/// Requested actions; the largest over all ranks applies.
enum Wish : std::int64_t
{
    go_on,
    write,
    stop_by_limit,
    stop_by_caller,
    stop_by_signal
};

Wish wish_of(Request request)
{
    switch (request)
    {
    case Request::stop:
        return stop_by_signal;
    case Request::checkpoint:
        return write;
    case Request::none:
        break;
    }
    return go_on;
}

std::string signal_text()
{
    const std::string name = SignalWatch::last_name();
    return name.empty() ? "a signal to another rank" : "signal " + name;
}

std::string reason_of(std::int64_t stop)
{
    if (stop == stop_by_limit) { return "the wall-time limit"; }
    return stop == stop_by_caller ? "the calling program" : signal_text();
}

} // namespace

double wall_clock()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CheckpointClock::CheckpointClock(const scene::CheckpointOptions& options, double limit, double start, double time,
                                 std::int64_t step)
    : options_(options)
    , end_(limit > 0 ? start + limit : std::numeric_limits<double>::infinity())
    , last_check_(wall_clock())
    , last_written_(last_check_)
    , last_time_(time)
    , last_step_(step)
{
}

Interruption CheckpointClock::check(const Communicator& communicator, double time, std::int64_t step)
{
    const double now = wall_clock();
    slowest_         = std::max(slowest_, now - last_check_);
    last_check_      = now;
    Wish wish        = wish_of(SignalWatch::take());
    if (stop_asked_ && stop_asked_()) { wish = std::max(wish, stop_by_caller); }
    if (communicator.rank() == 0)
    {
        const bool due = (options_.every_wall > 0 && now - last_written_ >= options_.every_wall) ||
                         (options_.every_time > 0 && time - last_time_ >= options_.every_time * (1 - 1e-9)) ||
                         (options_.every_steps > 0 && step - last_step_ >= options_.every_steps);
        if (due) { wish = std::max(wish, write); }
        if (now + std::max(2 * cost_ + slowest_, least_margin) >= end_) { wish = std::max(wish, stop_by_limit); }
    }
    const auto all = communicator.maximum(wish);
    if (all < stop_by_limit) { return {all == write, false, ""}; }
    return {true, true, reason_of(all)};
}

std::optional<std::string> CheckpointClock::check_within_step(const Communicator& communicator) const
{
    Wish wish = SignalWatch::stop_is_asked() ? stop_by_signal : go_on;
    if (stop_asked_ && stop_asked_()) { wish = std::max(wish, stop_by_caller); }
    if (communicator.rank() == 0 && wall_clock() + least_margin >= end_) { wish = std::max(wish, stop_by_limit); }
    const auto all = communicator.maximum(wish);
    return all < stop_by_limit ? std::nullopt : std::optional<std::string>(reason_of(all));
}

void CheckpointClock::written(double time, std::int64_t step, double seconds)
{
    cost_         = seconds;
    last_written_ = last_check_ = wall_clock();
    last_time_                  = time;
    last_step_                  = step;
}

} // namespace tread::run
