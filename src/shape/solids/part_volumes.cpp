#include "shape/solids/part_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/mesh/components.hpp"

namespace tread::shape
{
namespace
{

/// Integrals over space of the rounded winding number: m3.
struct WoundVolumes
{
    double all    = 0; ///< of the winding number
    double shared = 0; ///< of its excess over 1, where parts overlap
    double error  = 0; ///< standard error of `shared`, as for random positions
};

/// Samples the box by the additive sequence of the root of x^4 = x + 1 (Roberts 2018).
WoundVolumes sample_wound_volumes(const TriangleMesh& surface)
{
    constexpr std::size_t count = 1 << 16;
    constexpr double      root  = 1.22074408460575947536;
    const Bounds          box   = bounds(surface);
    const WindingTree     tree  = build_winding_tree(surface);
    const Eigen::Vector3d ways(1 / root, 1 / (root * root), 1 / (root * root * root));

    double all = 0, shared = 0, squares = 0;
#pragma omp parallel for schedule(dynamic, 1024) reduction(+ : all, shared, squares)
    for (std::size_t i = 0; i < count; ++i)
    {
        Eigen::Vector3d part = static_cast<double>(i + 1) * ways;
        part -= part.array().floor().matrix();
        const auto number =
            static_cast<double>(std::lround(winding_number(tree, box.low + part.cwiseProduct(box.extent()))));
        const double over = std::max(number - 1, 0.0);
        all += number;
        shared += over;
        squares += over * over;
    }
    const double share = box.extent().prod() / static_cast<double>(count), mean = shared / static_cast<double>(count);
    return {share * all, share * shared, share * std::sqrt(std::max(squares - shared * mean, 0.0))};
}

/// All parts that face one way.
struct Facing
{
    std::size_t count  = 0;
    double      volume = 0; ///< m3, sum over the parts, positive
};

} // namespace

void require_volume_of_parts(const TriangleMesh& surface, double volume, const std::string& origin)
{
    constexpr double accepted = 0.2, deviations = 3;

    Facing outwards, inwards;
    for (const double own : signed_volumes(surface, find_components(surface)))
    {
        Facing& facing = own < 0 ? inwards : outwards;
        ++facing.count;
        facing.volume += std::abs(own);
    }
    const WoundVolumes wound    = sample_wound_volumes(surface);
    const bool         closed   = describe_defects(surface).empty();
    const double       expected = (closed ? outwards.volume - inwards.volume : wound.all) - wound.shared;
    if (std::abs(volume - expected) <= accepted * std::abs(expected) + deviations * wound.error) { return; }
    throw InputError(fmt::format(
        "{}: the solid would have {:.6g} m3, but its parts have {:.6g} m3 by their own volumes: {} solid parts hold "
        "{:.6g} "
        "m3, {} cavities {:.6g} m3, and {:.6g} m3 of it are held more than once; at most {:.0f} % of difference is "
        "accepted. Some part is inside out in places; wind all triangles counter-clockwise seen from outside, or unite "
        "the parts where the mesh was made",
        origin, volume, expected, outwards.count, outwards.volume, inwards.count, inwards.volume, wound.shared,
        100 * accepted));
}

} // namespace tread::shape
