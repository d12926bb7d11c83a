#include "solver/ranks/body_numbers.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "kernels/dem/pairs/pairs.hpp"

namespace tread::solver
{

BodyNumbers::BodyNumbers(std::vector<std::int32_t> numbers, std::size_t bodies)
    : numbers_(std::move(numbers))
    , bodies_(bodies)
{
}

std::optional<std::int32_t> BodyNumbers::find_row(std::int64_t number) const
{
    if (!numbers_) { return static_cast<std::int32_t>(number); }
    const auto at = std::lower_bound(numbers_->begin(), numbers_->end(), number);
    if (at == numbers_->end() || *at != number) { return {}; }
    return static_cast<std::int32_t>(at - numbers_->begin());
}

std::vector<std::int32_t> BodyNumbers::rows_of(const std::vector<std::int32_t>& numbers) const
{
    std::vector<std::int32_t> rows;
    rows.reserve(numbers.size());
    for (const std::int32_t number : numbers) { rows.push_back(find_row(number).value()); }
    return rows;
}

std::uint64_t BodyNumbers::key_in_scene(std::uint64_t key) const
{
    const auto         count = static_cast<std::int64_t>(rows());
    const std::int64_t b     = dem::second_of(key);
    const std::int64_t other = b < count ? number(b) : b - count + static_cast<std::int64_t>(bodies_);
    return dem::pair_key(number(dem::first_of(key)), other) + dem::patch_number(key);
}

std::optional<std::uint64_t> BodyNumbers::find_key(std::uint64_t key) const
{
    const auto         count = static_cast<std::int64_t>(bodies_);
    const std::int64_t b     = dem::second_of(key);
    const auto         first = find_row(dem::first_of(key));
    const auto second = b < count ? find_row(b) : std::optional(static_cast<std::int32_t>(b - count) + wall_row());
    if (!first || !second) { return {}; }
    return dem::pair_key(*first, *second) + dem::patch_number(key);
}

std::vector<std::int32_t> BodyNumbers::all() const
{
    if (numbers_) { return *numbers_; }
    std::vector<std::int32_t> every(bodies_);
    std::iota(every.begin(), every.end(), 0);
    return every;
}

std::optional<RowChange> change_between(const std::vector<std::int32_t>& before, const std::vector<std::int32_t>& now)
{
    if (before == now) { return {}; }
    RowChange   change{std::vector<std::int32_t>(now.size(), -1), std::vector<std::int32_t>(before.size(), -1)};
    std::size_t old = 0;
    for (std::size_t row = 0; row < now.size(); ++row)
    {
        while (old < before.size() && before[old] < now[row]) { ++old; }
        if (old == before.size() || before[old] != now[row]) { continue; }
        change.from[row] = static_cast<std::int32_t>(old);
        change.to[old]   = static_cast<std::int32_t>(row);
    }
    return change;
}

} // namespace tread::solver
