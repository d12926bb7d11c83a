#include "base/wait_note.hpp"

namespace tread
{

void WaitNote::begin(const char* what, const std::vector<int>& ranks)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    what_ = what;
    ranks_.assign(ranks.begin(), ranks.end());
    since_ = Clock::now();
}

void WaitNote::begin_collective(const char* what)
{
    if (collectives_ != nullptr) { ++*collectives_; }
    begin(what, {});
}

void WaitNote::end()
{
    const std::lock_guard<std::mutex> lock(mutex_);
    what_ = nullptr;
}

std::optional<WaitNote::Wait> WaitNote::present() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    if (what_ == nullptr) { return std::nullopt; }
    return Wait{what_, ranks_, since_};
}

} // namespace tread
