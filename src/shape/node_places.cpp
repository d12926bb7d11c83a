#include "shape/node_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>

#include "shape/mesh/point_directory.hpp"

namespace tread::shape
{
namespace
{

double total_area(const SurfaceSamples& samples)
{
    return std::accumulate(samples.areas.begin(), samples.areas.end(), 0.0);
}

/// Eliminates samples, the most crowded first.
class Elimination
{
public:
    /// `reach` (m): distance within which samples crowd each other.
    Elimination(const SurfaceSamples& samples, double reach)
        : samples_(samples)
        , reach_(reach)
        , directory_(reach)
        , crowding_(samples.positions.size(), 0.0)
        , left_(samples.positions.size(), true)
    {
        for (std::size_t i = 0; i < left_.size(); ++i) { directory_.add(samples.positions[i], samples.normals[i]); }
        for (std::size_t i = 0; i < left_.size(); ++i)
        {
            for_each_crowded_by(i, [&](std::size_t other, double amount) { crowding_[other] += amount; });
        }
        for (std::size_t i = 0; i < left_.size(); ++i) { queue_.emplace(crowding_[i], i); }
    }

    /// An outdated entry of the queue comes before its sample's true one and is reinserted.
    void take_away(std::size_t count)
    {
        while (count > 0)
        {
            const auto [crowding, i] = queue_.top();
            queue_.pop();
            if (!left_[i]) { continue; }
            if (crowding > crowding_[i])
            {
                queue_.emplace(crowding_[i], i);
                continue;
            }
            left_[i] = false;
            directory_.remove(i, samples_.positions[i]);
            --count;
            for_each_crowded_by(i, [&](std::size_t other, double amount) { crowding_[other] -= amount; });
        }
    }

    std::vector<std::size_t> left() const
    {
        std::vector<std::size_t> places;
        for (std::size_t i = 0; i < left_.size(); ++i)
        {
            if (left_[i]) { places.push_back(i); }
        }
        return places;
    }

private:
    /// Visits the samples that a sample crowds, of its own kind or less sharp, with a weight that grows with proximity.
    template<class Visit>
    void for_each_crowded_by(std::size_t i, Visit visit) const
    {
        directory_.for_each_near(samples_.positions[i], samples_.normals[i],
                                 [&](std::size_t other, double squared)
                                 {
                                     if (other == i || samples_.kinds[other] < samples_.kinds[i]) { return; }
                                     // A sample on an edge has two neighbours, one on a face has six; by measurement, 8
                                     // spaces both alike.
                                     const double share = samples_.kinds[other] == Sharpness::smooth ? 1 : 8;
                                     const double near  = 1 - std::sqrt(squared) / reach_;
                                     const double four  = near * near * near * near;
                                     visit(other, share * four * four);
                                 });
    }

    const SurfaceSamples&                               samples_;
    double                                              reach_;
    PointDirectory                                      directory_;
    std::vector<double>                                 crowding_;
    std::vector<bool>                                   left_;
    std::priority_queue<std::pair<double, std::size_t>> queue_;
};

/// Nearest of all positions, if none is near; those that do not face away come first.
std::size_t nearest_of_all(const SurfaceSamples& samples, const std::vector<std::size_t>& places, std::size_t sample)
{
    const auto distance = [&](std::size_t place)
    {
        const double facing = samples.normals[place].dot(samples.normals[sample]);
        return std::pair(facing < PointDirectory::facing_away,
                         (samples.positions[place] - samples.positions[sample]).squaredNorm());
    };
    const auto nearest =
        std::min_element(places.begin(), places.end(),
                         [&](std::size_t one, std::size_t other) { return distance(one) < distance(other); });
    return static_cast<std::size_t>(nearest - places.begin());
}

/// Moves each node to the sample of its kind that is nearest to the centre of its Voronoi cell, or, on an edge, of the
/// edges in the cell.
void centre(const SurfaceSamples& samples, const std::vector<std::size_t>& owners, std::vector<std::size_t>& places)
{
    const auto                   from = places;
    std::vector<Eigen::Vector3d> middles(places.size(), Eigen::Vector3d::Zero());
    std::vector<double>          weights(places.size(), 0.0);
    for (std::size_t i = 0; i < owners.size(); ++i)
    {
        const std::size_t owner = owners[i];
        if (samples.kinds[i] > samples.kinds[from[owner]]) { continue; }
        middles[owner] += samples.areas[i] * samples.positions[i];
        weights[owner] += samples.areas[i];
    }
    std::vector<double> least(places.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < owners.size(); ++i)
    {
        const std::size_t owner = owners[i];
        if (samples.kinds[i] != samples.kinds[from[owner]] || samples.kinds[i] == Sharpness::corner) { continue; }
        const double squared = (samples.positions[i] - middles[owner] / weights[owner]).squaredNorm();
        if (squared >= least[owner]) { continue; }
        least[owner]  = squared;
        places[owner] = i;
    }
}

} // namespace

std::vector<std::size_t> spread(const SurfaceSamples& samples, std::size_t count)
{
    const std::size_t all = samples.positions.size();
    // Twice the largest radius of `count` equal discs side by side (Yuksel 2015).
    const double reach = 2 * std::sqrt(total_area(samples) / (2 * std::sqrt(3.0) * static_cast<double>(count)));
    Elimination  elimination(samples, reach);
    elimination.take_away(all - std::min(all, count));
    return elimination.left();
}

std::vector<std::size_t> evened(const SurfaceSamples& samples, std::vector<std::size_t> places)
{
    constexpr int most_rounds = 10;
    for (int round = 0; round < most_rounds; ++round)
    {
        const auto before = places;
        centre(samples, nearest_places(samples, places), places);
        if (places == before) { break; }
    }
    return places;
}

std::vector<std::size_t> nearest_places(const SurfaceSamples& samples, const std::vector<std::size_t>& places)
{
    const double   spacing = std::sqrt(total_area(samples) / static_cast<double>(places.size()));
    PointDirectory directory(1.5 * spacing);
    for (const std::size_t place : places) { directory.add(samples.positions[place], samples.normals[place]); }
    std::vector<std::size_t> owners(samples.positions.size());
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < owners.size(); ++i)
    {
        const auto near = directory.nearest(samples.positions[i], samples.normals[i]);
        owners[i]       = near ? *near : nearest_of_all(samples, places, i);
    }
    return owners;
}

} // namespace tread::shape
