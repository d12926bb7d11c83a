#include "kernels/dem/contact/ray_shape.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace tread::dem
{
namespace
{

/// Distance from the node to where the ray leaves the body, m. The ray of a node outside its own facets enters first.
double way_through(const RayView& body, const Vec3<double>& node, const Vec3<double>& direction, double start)
{
    constexpr int entries = 4;
    double        way     = start;
    for (int entry = 0; entry < entries; ++entry)
    {
        const RayHit hit = first_hit(body, node + way * direction, direction, std::numeric_limits<double>::max());
        if (hit.triangle < 0) { break; }
        way += hit.length;
        if (hit.cosine > 0) { break; }
        way += start;
    }
    return way;
}

} // namespace

std::vector<double> ray_lengths(const RayShape& shape, const std::vector<Vec3<double>>& nodes)
{
    constexpr double off_surface = 1e-6; // relative to the largest coordinate: skips the node's own triangle
    double           largest     = 0;
    for (const Vec3<double>& node : nodes) { largest = std::max(largest, node.cwiseAbs().maxCoeff()); }
    std::vector<double> lengths;
    lengths.reserve(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        lengths.push_back(0.5 * way_through(shape.view(), nodes[i], shape.inward[i], off_surface * largest));
    }
    return lengths;
}

} // namespace tread::dem
