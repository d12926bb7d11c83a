#include "world/world_measures.hpp"

#include <algorithm>
#include <cmath>

namespace tread::world
{
namespace
{

constexpr double      largest_rounding = 1e-9; ///< relative, of a sum of up to 1e9 terms
constexpr std::size_t weights          = 101;  ///< number of cyclic weights, which make the sums depend on the order

/// Sum of masses, and of places times masses and weights.
struct Moments
{
    std::size_t  count  = 0;
    double       sum    = 0;
    Vec3<double> moment = Vec3<double>::Zero();

    void add(const Vec3<double>& place, double mass)
    {
        sum += mass;
        moment += static_cast<double>(1 + count % weights) * mass * place;
        ++count;
    }
};

void append(const Moments& all, std::vector<double>& to)
{
    for (const double value : {static_cast<double>(all.count), all.sum, all.moment[0], all.moment[1], all.moment[2]})
    {
        to.push_back(value);
    }
}

/// Moments of the points' masses, and of their volumes.
void add_sand(const Sand& sand, std::vector<double>& to)
{
    Moments mass, volume;
    for_each_point(sand,
                   [&](const SandPoint& point)
                   {
                       mass.add(point.position, point.kind.mass);
                       volume.add(point.position, point.kind.volume);
                   });
    append(mass, to);
    append(volume, to);
}

void add_masses(const std::vector<Vec3<double>>& place, const std::vector<double>& mass, std::vector<double>& to)
{
    Moments all;
    for (std::size_t i = 0; i < mass.size(); ++i) { all.add(place[i], mass[i]); }
    append(all, to);
}

} // namespace

std::vector<double> body_measures(const HostBodies& bodies)
{
    bodies.require_rocks();
    std::vector<double> found;
    add_masses(bodies.position, bodies.mass, found);
    add_masses(bodies.position, bodies.scale, found);
    return found;
}

std::vector<double> measures(const World& world, const std::vector<double>& bodies)
{
    std::vector<double> found;
    add_sand(world.sand, found);
    found.insert(found.end(), bodies.begin(), bodies.end());
    for (const shape::ShapeTemplate& form : world.templates)
    {
        found.insert(found.end(), {form.unit.volume, static_cast<double>(form.mesh.triangles.size()),
                                   static_cast<double>(form.nodes.positions.size())});
    }
    return found;
}

bool are_same(const std::vector<double>& one, const std::vector<double>& other)
{
    const auto close = [](double a, double b)
    { return std::abs(a - b) <= largest_rounding * std::max(std::abs(a), std::abs(b)); };
    return std::equal(one.begin(), one.end(), other.begin(), other.end(), close);
}

} // namespace tread::world
