#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

// Bounds on the data sets of a checkpoint or a bed. These files may come from anywhere, and kernels do not check
// indices and sizes, so each is checked where it is loaded.
namespace tread::io::accept
{

/// Reason for refusing values.
struct Refusal
{
    std::int64_t row; ///< negative: concerns no single row
    std::string  value;
    std::string  accepted;
};

/// Result of a bound, a callable on the loaded values; empty if they are accepted.
using Verdict = std::optional<Refusal>;

/// Casts a number to itself, and a struct of doubles to a row of doubles.
template<class T>
using Word = std::conditional_t<std::is_arithmetic_v<T>, T, double>;
template<class T>
inline constexpr std::size_t words = sizeof(T) / sizeof(Word<T>);

namespace detail
{

/// Applies `holds` to every word of every value.
template<class T, class Holds>
Verdict each_word(const std::vector<T>& values, const Holds& holds, const std::string& accepted)
{
    const auto* word = reinterpret_cast<const Word<T>*>(values.data());
    for (std::size_t i = 0; i < values.size() * words<T>; ++i)
    {
        if (holds(word[i])) { continue; }
        return Refusal{static_cast<std::int64_t>(i / words<T>), fmt::format("{}", word[i]), accepted};
    }
    return {};
}

} // namespace detail

/// Accepts anything: for bytes that are checked elsewhere.
inline auto anything()
{
    return [](const auto&) -> Verdict { return {}; };
}

/// Accepts finite numbers.
inline auto finite()
{
    return []<class T>(const std::vector<T>& values) -> Verdict
    {
        static_assert(std::is_floating_point_v<Word<T>>, "an integer has a range");
        return detail::each_word(
            values, [](auto word) { return std::isfinite(word); }, "a finite number");
    };
}

/// Accepts finite numbers, and NaN, which marks an absent value.
inline auto finite_or_none()
{
    return []<class T>(const std::vector<T>& values) -> Verdict
    {
        return detail::each_word(
            values, [](auto word) { return !std::isinf(word); }, "a finite number, or NaN for none");
    };
}

/// Accepts numbers from `low` to `high`, inclusive.
inline auto within(double low, double high)
{
    return [low, high]<class T>(const std::vector<T>& values) -> Verdict
    {
        static_assert(std::is_floating_point_v<Word<T>> || sizeof(T) < sizeof(double), "doubles do not hold them all");
        return detail::each_word(
            values, [&](auto word) { return low <= static_cast<double>(word) && static_cast<double>(word) <= high; },
            fmt::format("{} to {}", low, high));
    };
}

inline constexpr double largest = std::numeric_limits<double>::max();

/// Accepts finite positive numbers.
inline auto positive() { return within(std::numeric_limits<double>::min(), largest); }

/// Accepts finite non-negative numbers.
inline auto not_negative() { return within(0, largest); }

/// Accepts indices into `count` items.
inline auto index(std::size_t count) { return within(0, static_cast<double>(count) - 1); }

/// Accepts values that satisfy all bounds, checked in order.
template<class... Bounds>
auto all(Bounds... bounds)
{
    return [bounds...](const auto& values) -> Verdict
    {
        Verdict verdict;
        static_cast<void>(((verdict = bounds(values), verdict.has_value()) || ...));
        return verdict;
    };
}

/// Accepts exactly `count` values.
inline auto rows(std::size_t count)
{
    return [count](const auto& values) -> Verdict
    {
        if (values.size() == count) { return {}; }
        return Refusal{-1, fmt::format("{} rows", values.size()), fmt::format("{} rows", count)};
    };
}

/// Accepts values that all satisfy holds(value).
template<class Holds>
auto each(std::string accepted, Holds holds)
{
    return [accepted = std::move(accepted), holds](const auto& values) -> Verdict
    {
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            if (holds(values[i])) { continue; }
            std::string text = "another value";
            if constexpr (std::is_arithmetic_v<std::decay_t<decltype(values[i])>>)
            {
                text = fmt::format("{}", values[i]);
            }
            return Refusal{static_cast<std::int64_t>(i), text, accepted};
        }
        return {};
    };
}

/// Accepts values that all satisfy holds(index, value); `accepted(index)` describes the expected value.
template<class Holds, class Accepted>
auto each_at(Holds holds, Accepted accepted)
{
    return [holds, accepted](const auto& values) -> Verdict
    {
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            if (!holds(i, values[i]))
            {
                return Refusal{static_cast<std::int64_t>(i), fmt::format("{}", values[i]), accepted(i)};
            }
        }
        return {};
    };
}

/// Accepts values equal to `present`, which a state cannot change; floating-point numbers to 1e-6.
template<class T>
auto same_as(std::vector<T> present)
{
    return [present = std::move(present)](const std::vector<T>& values) -> Verdict
    {
        if (auto refusal = rows(present.size())(values)) { return refusal; }
        const auto* ours   = reinterpret_cast<const Word<T>*>(present.data());
        const auto* theirs = reinterpret_cast<const Word<T>*>(values.data());
        for (std::size_t i = 0; i < words<T> * present.size(); ++i)
        {
            bool same = ours[i] == theirs[i];
            if constexpr (std::is_floating_point_v<Word<T>>)
            {
                // Scales along a row: products of inertia are rounding errors of its moments.
                double scale = 0;
                for (std::size_t k = i - i % words<T>; k < i - i % words<T> + words<T>; ++k)
                {
                    scale = std::max<double>(scale, std::abs(ours[k]));
                }
                same = std::abs(ours[i] - theirs[i]) <= 1e-6 * scale;
            }
            if (same) { continue; }
            return Refusal{static_cast<std::int64_t>(i / words<T>), fmt::format("{}", theirs[i]),
                           fmt::format("{}, which the scene gives it", ours[i])};
        }
        return {};
    };
}

/// Accepts values in ascending order; equal neighbours are allowed.
inline auto ascending()
{
    return [](const auto& values) -> Verdict
    {
        const auto at = std::is_sorted_until(values.begin(), values.end());
        if (at == values.end()) { return {}; }
        return Refusal{at - values.begin(), fmt::format("{}", *at),
                       fmt::format("at least {}, the one before it", *(at - 1))};
    };
}

/// Accepts values without duplicates.
inline auto distinct()
{
    return [](auto values) -> Verdict
    {
        std::sort(values.begin(), values.end());
        const auto at = std::adjacent_find(values.begin(), values.end());
        if (at == values.end()) { return {}; }
        return Refusal{-1, fmt::format("{} twice", *at), "each value once"};
    };
}

/// Accepts offsets that split a list into runs: from 0, ascending. The list's own bound must check the last one.
inline auto cuts()
{
    return [](const auto& values) -> Verdict
    {
        if (!values.empty() && values.front() != 0)
        {
            return Refusal{0, fmt::format("{}", values.front()), "0, where the list begins"};
        }
        return ascending()(values);
    };
}

/// Accepts offsets that split a list of `end` items into `count` runs: `count` + 1 of them.
inline auto offsets(std::size_t count, std::int64_t end)
{
    return [count, end](const auto& values) -> Verdict
    {
        if (auto refusal = all(rows(count + 1), cuts())(values)) { return refusal; }
        if (values.back() == end) { return {}; }
        return Refusal{static_cast<std::int64_t>(count), fmt::format("{}", values.back()),
                       fmt::format("{}, where the list ends", end)};
    };
}

/// Accepts a permutation of the numbers from 0 to `count` - 1.
inline auto permutation(std::size_t count)
{
    return [count](const auto& values) -> Verdict
    {
        if (auto refusal = rows(count)(values)) { return refusal; }
        std::vector<bool> seen(count, false);
        for (std::size_t i = 0; i < count; ++i)
        {
            const auto at = static_cast<std::size_t>(values[i]);
            if (values[i] >= 0 && at < count && !seen[at])
            {
                seen[at] = true;
                continue;
            }
            return Refusal{static_cast<std::int64_t>(i), fmt::format("{}", values[i]),
                           fmt::format("each of 0 to {} once", static_cast<std::int64_t>(count) - 1)};
        }
        return {};
    };
}

/// Accepts quaternions of unit length.
inline auto unit_quaternions()
{
    return each("a quaternion of length 1", [](const auto& turn) { return std::abs(turn.squaredNorm() - 1) <= 1e-6; });
}

/// Accepts a single number within bounds, inclusive. Integers must be whole, booleans 0 or 1.
template<class T>
struct Bounded
{
    T&     value;
    double low, high;
};

template<class T>
Bounded<T> number(T& value, double low, double high)
{
    return {value, low, high};
}

/// Accepts whatever the type can hold: finite numbers, and integers that a double holds exactly.
template<class T>
Bounded<T> by_type(T& value)
{
    static_assert(std::is_arithmetic_v<T>, "words of an enum have a range");
    constexpr double whole = 9007199254740992.0; // 2^53
    if constexpr (std::is_floating_point_v<T>) { return {value, -largest, largest}; }
    else
    {
        return {value, std::max(-whole, static_cast<double>(std::numeric_limits<T>::min())),
                std::min(whole, static_cast<double>(std::numeric_limits<T>::max()))};
    }
}
template<class T>
Bounded<T> by_type(Bounded<T>& value)
{
    return value;
}

} // namespace tread::io::accept
