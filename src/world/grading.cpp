#include "world/grading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "base/random.hpp"

namespace tread::world
{
namespace
{

constexpr std::size_t most_rocks = 100'000'000;

/// Share of the standard normal distribution between two scores, computed in the tail without loss of digits.
double normal_share(double low, double high)
{
    const double root = std::numbers::sqrt2;
    return low > 0 ? 0.5 * (std::erfc(low / root) - std::erfc(high / root))
                   : 0.5 * (std::erfc(-high / root) - std::erfc(-low / root));
}

/// Quantile of the normal distribution truncated to [low, high]: score below which a share `u` lies, by bisection from
/// the nearer end, so that the thin tail keeps its digits.
double truncated_normal_quantile(double low, double high, double u)
{
    const double total    = normal_share(low, high);
    const auto   short_of = [&](double score)
    { return u < 0.5 ? normal_share(low, score) < u * total : normal_share(score, high) > (1 - u) * total; };
    double below = low, above = high;
    for (int i = 0; i < 60; ++i)
    {
        const double middle                = 0.5 * (below + above);
        (short_of(middle) ? below : above) = middle;
    }
    return 0.5 * (below + above);
}

struct Quantile
{
    double u;

    double operator()(double diameter) const { return diameter; }

    double operator()(const scene::UniformDiameters& spread) const { return std::lerp(spread.low, spread.high, u); }

    double operator()(const scene::LogNormalDiameters& spread) const
    {
        const auto   score = [&](double d) { return std::log(d / spread.median) / spread.deviation; };
        const double at    = truncated_normal_quantile(score(spread.low), score(spread.high), u);
        return std::clamp(spread.median * std::exp(spread.deviation * at), spread.low, spread.high);
    }

    /// Density proportional to d^-n: with m = 1 - n, d = low [1 + u ((high/low)^m - 1)]^(1/m); the limit at m = 0 is
    /// geometric.
    double operator()(const scene::PowerLawDiameters& spread) const
    {
        const double m = 1 - spread.exponent, ratio = std::log(spread.high / spread.low);
        const double growth = std::abs(m * ratio) < 1e-9 ? u * ratio : std::log1p(u * std::expm1(m * ratio)) / m;
        return std::clamp(spread.low * std::exp(growth), spread.low, spread.high);
    }
};

/// m3, mean and largest volume of a table's rocks.
struct Volumes
{
    double mean;
    double largest;
};

Volumes volumes_of(const scene::Diameter& diameter)
{
    constexpr int parts = 4096; // intervals of the distribution of equal probability
    double        sum   = 0;
    for (int part = 0; part < parts; ++part) { sum += sphere_volume(quantile(diameter, (part + 0.5) / parts)); }
    return {sum / parts, sphere_volume(quantile(diameter, 1))};
}

std::string text_of(const scene::Rocks& rocks)
{
    return rocks.count ? fmt::format("count = {}", *rocks.count)
                       : fmt::format("solid_fraction = {}", *rocks.solid_fraction);
}

/// Refuses, before any is drawn, rocks that almost certainly (by four standard deviations of the sum) exceed the
/// region's volume, the largest number, or memory.
void require_possible(const scene::Rocks& rocks, double volume)
{
    constexpr double deviations = 4, bytes_a_rock = 400; // as drawn, as a body, and in the body grid
    const Volumes    one = volumes_of(rocks.diameter);
    const double count   = rocks.count ? static_cast<double>(*rocks.count) : *rocks.solid_fraction * volume / one.mean;
    const double least   = count * one.mean * (1 - deviations * std::sqrt(one.largest / (one.mean * count)));
    const auto   table   = fmt::format("[[rocks]] of shape '{}': {}", rocks.shape, text_of(rocks));
    if (rocks.count && least > volume)
    {
        throw InputError(fmt::format("{}: rocks of {:.4g} m3 in a region of {:.4g} m3; accepted: rocks that fit "
                                     "without overlap, at most {:.0f} of this size",
                                     table, count * one.mean, volume, std::floor(volume / one.mean)));
    }
    if (count > 1.1 * static_cast<double>(most_rocks))
    {
        throw InputError(
            fmt::format("{} of {:.4g} m3 is {:.3g} rocks; accepted: at most {}", table, volume, count, most_rocks));
    }
    require_host_memory({bytes_a_rock * count, fmt::format("{}: {:.3g} rocks", table, count),
                         "fewer or larger rocks, or a smaller region"});
}

/// Whether the volume so far is nearer to `wanted` than with one more rock.
bool enough(const scene::Rocks& rocks, std::size_t drawn, double filled, double next, double wanted)
{
    if (rocks.count) { return drawn == static_cast<std::size_t>(*rocks.count); }
    return filled + 0.5 * sphere_volume(next) > wanted;
}

} // namespace

double quantile(const scene::Diameter& diameter, double u) { return std::visit(Quantile{u}, diameter); }

double sphere_volume(double diameter) { return std::numbers::pi / 6 * diameter * diameter * diameter; }

std::vector<RockDraw> draw_rocks(const scene::Rocks& rocks, double volume, std::size_t members)
{
    require_possible(rocks, volume);
    const double          wanted = rocks.solid_fraction.value_or(0) * volume;
    Random                random(rocks.seed);
    std::vector<RockDraw> drawn;
    for (double filled = 0;;)
    {
        const double diameter = quantile(rocks.diameter, random.uniform());
        const auto   member   = static_cast<std::int32_t>(random.uniform() * static_cast<double>(members));
        if (enough(rocks, drawn.size(), filled, diameter, wanted)) { break; }
        drawn.push_back({diameter, member});
        filled += sphere_volume(diameter);
        if (drawn.size() > most_rocks)
        {
            throw InputError(fmt::format("[[rocks]] of shape '{}': solid_fraction = {} of {:.4g} m3 is over {} rocks",
                                         rocks.shape, *rocks.solid_fraction, volume, most_rocks));
        }
    }
    if (drawn.empty())
    {
        throw InputError(fmt::format("[[rocks]] of shape '{}': solid_fraction = {} of {:.4g} m3 is less than one rock",
                                     rocks.shape, rocks.solid_fraction.value_or(0), volume));
    }
    std::stable_sort(drawn.begin(), drawn.end(),
                     [](const RockDraw& a, const RockDraw& b) { return a.diameter > b.diameter; });
    return drawn;
}

} // namespace tread::world
