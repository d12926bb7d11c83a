#include "run/steady.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace tread::run
{
namespace
{

constexpr double none = std::numeric_limits<double>::quiet_NaN();

constexpr std::size_t most_batches   = 100;  ///< batches into which a series is divided
constexpr double      shortest_share = 0.4;  ///< least share of the series after the transient
constexpr double      significant    = 3;    ///< trend over its own uncertainty
constexpr double      notable        = 0.05; ///< trend over the mean or the deviation
constexpr std::size_t independent    = 8;    ///< parts whose means are assumed independent

using Values = std::span<const double>;

double mean(Values values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(Values values)
{
    const double middle = mean(values);
    double       sum    = 0;
    for (const double value : values) { sum += (value - middle) * (value - middle); }
    return sum / static_cast<double>(values.size());
}

/// Means of `independent` consecutive parts; the first ones have one value more where the number is not divisible.
std::vector<double> part_means(Values values)
{
    const std::size_t   shortest = values.size() / independent, longer = values.size() % independent;
    std::vector<double> means;
    for (std::size_t part = 0, first = 0; part < independent; ++part)
    {
        const std::size_t size = shortest + (part < longer ? 1 : 0);
        means.push_back(mean(values.subspan(first, size)));
        first += size;
    }
    return means;
}

std::vector<double> batch_means(Values values, std::size_t size)
{
    std::vector<double> means;
    for (std::size_t first = 0; first + size <= values.size(); first += size)
    {
        means.push_back(mean(values.subspan(first, size)));
    }
    return means;
}

/// Number of values in the transient.
std::size_t transient(Values values)
{
    const std::size_t         size  = std::max<std::size_t>(1, values.size() / most_batches);
    const std::vector<double> means = batch_means(values, size);
    const auto                last = static_cast<std::size_t>((1 - shortest_share) * static_cast<double>(means.size()));
    double                    least = std::numeric_limits<double>::infinity();
    std::size_t               found = 0;
    for (std::size_t cut = 0; cut <= last; ++cut)
    {
        const Values remaining = Values(means).subspan(cut);
        const double error     = variance(remaining) / static_cast<double>(remaining.size());
        if (error >= least) { continue; }
        least = error;
        found = cut;
    }
    return found * size;
}

/// Whether a line through the means of the parts has a slope that is significant and large enough to matter.
bool has_trend(Values time, Values values)
{
    const std::vector<double> times = part_means(time), means = part_means(values);
    const double              middle = mean(times), height = mean(means);

    double spread = 0, product = 0;
    for (std::size_t i = 0; i < independent; ++i)
    {
        spread += (times[i] - middle) * (times[i] - middle);
        product += (times[i] - middle) * (means[i] - height);
    }
    const double slope   = product / spread;
    double       squares = 0;
    for (std::size_t i = 0; i < independent; ++i)
    {
        const double off = means[i] - height - slope * (times[i] - middle);
        squares += off * off;
    }
    const double uncertainty = std::sqrt(squares / (independent - 2) / spread);
    const double rise        = std::abs(slope) * (time.back() - time.front());
    return std::abs(slope) > significant * uncertainty &&
           rise > notable * std::max(std::abs(mean(values)), std::sqrt(variance(values)));
}

} // namespace

std::optional<SteadyPart> steady_part(const std::vector<double>& time, const std::vector<double>& values)
{
    std::vector<double> when, known;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        if (!std::isfinite(values[i])) { continue; }
        when.push_back(time[i]);
        known.push_back(values[i]);
    }
    if (known.size() < fewest_steady_rows) { return {}; }
    const std::size_t first = transient(known);
    if (has_trend(Values(when).subspan(first), Values(known).subspan(first)))
    {
        return SteadyPart{when[known.size() / 2], false};
    }
    return SteadyPart{when[first], true};
}

Moments moments(const std::vector<double>& values)
{
    std::vector<double> known;
    std::copy_if(values.begin(), values.end(), std::back_inserter(known),
                 [](double value) { return std::isfinite(value); });
    if (known.empty()) { return {none, none, none}; }
    Moments found{mean(known), std::sqrt(variance(known)), none};
    if (known.size() >= independent) { found.error = std::sqrt(variance(part_means(known)) / (independent - 1)); }
    return found;
}

} // namespace tread::run
