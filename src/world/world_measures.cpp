#include "world/world_measures.hpp"

#include <algorithm>
#include <cmath>

namespace tread::world
{
namespace
{

constexpr double      largest_rounding = 1e-9; ///< relative, of a sum of up to 1e9 terms
constexpr std::size_t weights          = 101;  ///< number of cyclic weights, which make the sums depend on the order

/// Sum of the masses, and of places times masses and weights.
void add_masses(const std::vector<Vec3<double>>& place, const std::vector<double>& mass, std::vector<double>& to)
{
    double       sum    = 0;
    Vec3<double> moment = Vec3<double>::Zero();
    for (std::size_t i = 0; i < mass.size(); ++i)
    {
        sum += mass[i];
        moment += static_cast<double>(1 + i % weights) * mass[i] * place[i];
    }
    to.insert(to.end(), {static_cast<double>(mass.size()), sum, moment[0], moment[1], moment[2]});
}

} // namespace

std::vector<double> measures(const World& world)
{
    std::vector<double> found;
    add_masses(world.points.position, world.points.mass, found);
    add_masses(world.points.position, world.points.volume, found);
    add_masses(world.bodies.position, world.bodies.mass, found);
    add_masses(world.bodies.position, world.bodies.scale, found);
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
