#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "shape/generators.hpp"
#include "shape/mass_properties.hpp"
#include "shape/triangle.hpp"

namespace tread::shape
{
namespace
{

constexpr double pi = 3.14159265358979323846;

/// Uniform on the unit sphere.
Eigen::Vector3d direction(Random& random)
{
    const double height = 2 * random.uniform() - 1;
    const double turn   = 2 * pi * random.uniform();
    const double reach  = std::sqrt(1 - height * height);
    return {reach * std::cos(turn), reach * std::sin(turn), height};
}

/// A function on the unit sphere: a few plane waves of 2 to 6 rad a radius, scaled to a largest magnitude of 1.
std::vector<double> bumps(const std::vector<Eigen::Vector3d>& directions, std::uint64_t seed)
{
    constexpr int       waves = 10;
    Random              random(seed);
    std::vector<double> heights(directions.size(), 0.0);
    for (int wave = 0; wave < waves; ++wave)
    {
        const double          number = 2 + 4 * random.uniform();
        const Eigen::Vector3d along  = number * direction(random);
        const double          phase  = 2 * pi * random.uniform();
        for (std::size_t i = 0; i < directions.size(); ++i)
        {
            heights[i] += std::cos(along.dot(directions[i]) + phase);
        }
    }
    double largest = 0;
    for (const double height : heights) { largest = std::max(largest, std::abs(height)); }
    for (double& height : heights) { height /= largest; }
    return heights;
}

/// The sphere with bumps of the given amplitude, stretched to the extents.
TriangleMesh bumpy_ellipsoid(const TriangleMesh& sphere, const std::vector<double>& heights, double amplitude,
                             const Eigen::Vector3d& extents)
{
    TriangleMesh mesh = sphere;
    for (std::size_t i = 0; i < heights.size(); ++i) { mesh.vertices[i] *= 1 + amplitude * heights[i]; }
    const Eigen::Vector3d stretch = extents.cwiseQuotient(bounds(mesh).extent());
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex = vertex.cwiseProduct(stretch); }
    return mesh;
}

void check(const scene::RockGenerator& generator, const std::string& origin)
{
    if (!(generator.aspect >= 0.2 && generator.aspect <= 1))
    {
        throw InputError(fmt::format("{}: aspect = {}: accepted are 0.2 to 1", origin, generator.aspect));
    }
    if (!(generator.sphericity > 0 && generator.sphericity <= 1))
    {
        throw InputError(fmt::format("{}: sphericity = {}: accepted are above 0 to 1", origin, generator.sphericity));
    }
}

} // namespace

double sphericity(const TriangleMesh& mesh)
{
    return std::cbrt(pi) * std::pow(6 * mass_properties(mesh).volume, 2.0 / 3.0) / surface_area(mesh);
}

TriangleMesh rock_mesh(const scene::RockGenerator& generator, const std::string& origin)
{
    check(generator, origin);
    // Radii from 0.35 to 1.65 of the ellipsoid's: beyond are spikes, which are no rocks and need more nodes than there
    // are.
    constexpr double most_amplitude = 0.65, tolerance = 0.03;

    const TriangleMesh        sphere  = icosphere(generator.nodes, origin);
    const std::vector<double> heights = bumps(sphere.vertices, generator.seed);
    const Eigen::Vector3d     extents(1, 0.5 * (1 + generator.aspect), generator.aspect);
    const auto make = [&](double amplitude) { return bumpy_ellipsoid(sphere, heights, amplitude, extents); };

    const double wanted = generator.sphericity;
    const double most = sphericity(make(0)), least = sphericity(make(most_amplitude));
    if (wanted > most * (1 + tolerance) || wanted < least * (1 - tolerance))
    {
        throw InputError(
            fmt::format("{}: sphericity = {}: with seed {}, aspect {} and {} nodes, {:.3f} to {:.3f} can be "
                        "reached",
                        origin, wanted, generator.seed, generator.aspect, generator.nodes, least, most));
    }
    double low = 0, high = most_amplitude;
    for (int halving = 0; halving < 30; ++halving)
    {
        const double middle                              = 0.5 * (low + high);
        (sphericity(make(middle)) > wanted ? low : high) = middle;
    }
    TriangleMesh mesh  = make(low);
    const double scale = std::cbrt(pi / 6 / mass_properties(mesh).volume);
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex *= scale; }
    return mesh;
}

} // namespace tread::shape
