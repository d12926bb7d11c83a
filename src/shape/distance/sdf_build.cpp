#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/host_memory.hpp"
#include "shape/distance/sdf_grid.hpp"

namespace tread::shape
{
namespace
{

constexpr std::int32_t edge       = SignedDistanceGrid::brick_cells;
constexpr std::int32_t edge_nodes = SignedDistanceGrid::brick_nodes;
constexpr std::size_t  per_brick  = std::size_t{edge_nodes} * edge_nodes * edge_nodes;
/// Fine cells beyond `reach`, the last of which is for interpolation: contact laws look no deeper without a guard.
constexpr double band_cells = 4;
/// Safety factor on bounds of magnitudes, for rounding.
constexpr double bit_more = 1.001;

using Index3 = std::array<std::int32_t, 3>;

std::size_t index(const Index3& counts, const Index3& i)
{
    return static_cast<std::size_t>(i[0]) +
           static_cast<std::size_t>(counts[0]) *
               (static_cast<std::size_t>(i[1]) + static_cast<std::size_t>(counts[1]) * static_cast<std::size_t>(i[2]));
}

Index3 place(const Index3& counts, std::size_t at)
{
    const auto nx = static_cast<std::size_t>(counts[0]), ny = static_cast<std::size_t>(counts[1]);
    return {static_cast<std::int32_t>(at % nx), static_cast<std::int32_t>(at / nx % ny),
            static_cast<std::int32_t>(at / (nx * ny))};
}

std::size_t total(const Index3& counts)
{
    return static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]) *
           static_cast<std::size_t>(counts[2]);
}

/// Calls visit(node, value) for all nodes first + stride * (i, j, k) of the grid, rows in parallel; values are in the
/// order of the indices, x fastest.
template<class Visit>
void sample_lattice(const SignedDistanceGrid& sdf, const Index3& counts, double stride, double shift,
                    const SignedDistance& distance, const Visit& visit)
{
    const double step = bit_more * stride * sdf.spacing;
#pragma omp parallel for collapse(2) schedule(dynamic, 4)
    for (std::int32_t k = 0; k < counts[2]; ++k)
    {
        for (std::int32_t j = 0; j < counts[1]; ++j)
        {
            double within = std::numeric_limits<double>::infinity();
            for (std::int32_t i = 0; i < counts[0]; ++i)
            {
                const Eigen::Vector3d in_cells = Eigen::Vector3d::Constant(shift) + stride * Eigen::Vector3d(i, j, k);
                const double          value    = distance(sdf.origin + sdf.spacing * in_cells, within);
                visit(index(counts, {i, j, k}), value);
                within = std::abs(value) + step;
            }
        }
    }
}

void fill_dense(SignedDistanceGrid& sdf, const SignedDistance& distance)
{
    sdf.values.resize(total(sdf.nodes));
    sample_lattice(sdf, sdf.nodes, 1, 0, distance,
                   [&](std::size_t at, double value) { sdf.values[at] = static_cast<float>(value); });
}

Index3 bricks_over(const SignedDistanceGrid& sdf)
{
    Index3 bricks{};
    for (std::size_t axis = 0; axis < 3; ++axis) { bricks[axis] = (sdf.nodes[axis] - 1 + edge - 1) / edge; }
    return bricks;
}

/// Signed distance (m) at the middle of every brick.
std::vector<double> middles_of(const SignedDistanceGrid& sdf, const Index3& bricks, const SignedDistance& distance)
{
    std::vector<double> middles(total(bricks));
    sample_lattice(sdf, bricks, edge, 0.5 * edge, distance, [&](std::size_t at, double value) { middles[at] = value; });
    return middles;
}

double half_diagonal(const SignedDistanceGrid& sdf) { return 0.5 * std::sqrt(3.0) * edge * sdf.spacing; }

/// A fine brick and its neighbours.
class Brick
{
public:
    Brick(const SignedDistanceGrid& sdf, std::size_t at)
        : sdf_(sdf)
        , at_(place(sdf.bricks, at))
    {
        for (std::int32_t n = 0; n < 27; ++n)
        {
            const Index3 other = neighbour(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            around_[static_cast<std::size_t>(n)] =
                exists(other) && sdf.slots[index(sdf.bricks, other)] < 0; // a coarse one
        }
    }

    /// Whether a node (0 to 8 along each axis) lies on a coarse brick.
    bool on_coarse(const Index3& node) const
    {
        for (std::int32_t n = 0; n < 27; ++n)
        {
            const bool touches =
                meets(node[0], n % 3 - 1) && meets(node[1], n / 3 % 3 - 1) && meets(node[2], n / 9 - 1);
            if (touches && around_[static_cast<std::size_t>(n)]) { return true; }
        }
        return false;
    }

    /// Brick that samples a node for all that share it: the one with the node on its lowest face, if there is one.
    Index3 owner(const Index3& node) const
    {
        Index3 brick = at_;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            brick[axis] += node[axis] == edge && at_[axis] + 1 < sdf_.bricks[axis] ? 1 : 0;
        }
        return brick;
    }

    /// Interpolant (m) of the corners at a node.
    double coarse_value(const Index3& node) const
    {
        const Index3 counts{sdf_.bricks[0] + 1, sdf_.bricks[1] + 1, sdf_.bricks[2] + 1};
        double       value = 0;
        for (std::int32_t c = 0; c < 8; ++c)
        {
            const Index3 side{c & 1, (c >> 1) & 1, c >> 2};
            double       weight = 1;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                weight *= (side[axis] == 1 ? node[axis] : edge - node[axis]) / double{edge};
            }
            if (weight == 0) { continue; }
            value +=
                weight * double{sdf_.corners[index(counts, {at_[0] + side[0], at_[1] + side[1], at_[2] + side[2]})]};
        }
        return value;
    }

    Eigen::Vector3d position(const Index3& node) const
    {
        return node_position(sdf_, edge * at_[0] + node[0], edge * at_[1] + node[1], edge * at_[2] + node[2]);
    }

    const Index3& at() const { return at_; }

private:
    Index3 neighbour(std::int32_t x, std::int32_t y, std::int32_t z) const
    {
        return {at_[0] + x, at_[1] + y, at_[2] + z};
    }

    bool exists(const Index3& brick) const
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (brick[axis] < 0 || brick[axis] >= sdf_.bricks[axis]) { return false; }
        }
        return true;
    }

    static bool meets(std::int32_t node, std::int32_t side)
    {
        return side == 0 || (side < 0 && node == 0) || (side > 0 && node == edge);
    }

    const SignedDistanceGrid& sdf_;
    Index3                    at_;
    std::array<bool, 27>      around_{};
};

template<class Visit>
void for_each_node(const Visit& visit)
{
    for (std::int32_t k = 0; k < edge_nodes; ++k)
    {
        for (std::int32_t j = 0; j < edge_nodes; ++j)
        {
            for (std::int32_t i = 0; i < edge_nodes; ++i) { visit(Index3{i, j, k}); }
        }
    }
}

const Index3 node_counts{edge_nodes, edge_nodes, edge_nodes};

float* values_of(SignedDistanceGrid& sdf, const Index3& brick)
{
    return sdf.values.data() + per_brick * static_cast<std::size_t>(sdf.slots[index(sdf.bricks, brick)]);
}

/// Samples the nodes that the brick owns. `within` (m) bounds every distance in it.
void sample_brick(SignedDistanceGrid& sdf, const Brick& brick, const SignedDistance& distance, double within)
{
    const double step   = bit_more * sdf.spacing;
    float*       values = values_of(sdf, brick.at());
    double       bound  = within;
    for_each_node(
        [&](const Index3& node)
        {
            if (node[0] == 0) { bound = within; }
            float& value = values[index(node_counts, node)];
            if (brick.on_coarse(node))
            {
                value = static_cast<float>(brick.coarse_value(node));
                bound = within;
                return;
            }
            if (brick.owner(node) != brick.at()) { return; }
            const double found = distance(brick.position(node), bound);
            value              = static_cast<float>(found);
            bound              = std::abs(found) + step;
        });
}

/// Copies the nodes that other bricks own.
void share_nodes(SignedDistanceGrid& sdf, const Brick& brick)
{
    float* values = values_of(sdf, brick.at());
    for_each_node(
        [&](const Index3& node)
        {
            const Index3 owner = brick.owner(node);
            if (owner == brick.at() || brick.on_coarse(node)) { return; }
            Index3 there{};
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                there[axis] = owner[axis] == brick.at()[axis] ? node[axis] : 0;
            }
            values[index(node_counts, node)] = values_of(sdf, owner)[index(node_counts, there)];
        });
}

double bytes_of_fine(double bricks) { return bricks * static_cast<double>(per_brick * sizeof(float)); }

/// Refuses a field that does not fit into memory: a value at each corner and middle of a brick, and `fine` fine bricks.
void require_room(const SignedDistanceGrid& sdf, double fine)
{
    constexpr double of_brick = sizeof(float) + sizeof(double) + sizeof(std::int32_t);
    double           bricks   = 1;
    for (const std::int32_t count : sdf.bricks) { bricks *= count; }
    require_host_memory({of_brick * bricks + bytes_of_fine(fine),
                         fmt::format("the {:.3g} cells of a shape's distance field", bricks * edge * edge * edge),
                         "fewer sdf_cells, or finer points beside a small body"});
}

/// Lower bound on the bricks that `reach` makes fine: half of its volume outside the shape's box.
double least_fine(const SignedDistanceGrid& sdf, double reach)
{
    double all = 1, inner = 1;
    for (const std::int32_t count : sdf.nodes)
    {
        all *= count;
        inner *= std::max(0.0, count - 2 * reach / sdf.spacing);
    }
    return reach > 0 ? 0.5 * (all - inner) / (edge * edge * edge) : 0;
}

void fill_bricks(SignedDistanceGrid& sdf, const SignedDistance& distance, double reach)
{
    const double band = reach + band_cells * sdf.spacing;
    sdf.fine_reach    = band - std::sqrt(3.0) * sdf.spacing;
    sdf.bricks        = bricks_over(sdf);
    require_room(sdf, least_fine(sdf, reach));

    const Index3 corners{sdf.bricks[0] + 1, sdf.bricks[1] + 1, sdf.bricks[2] + 1};
    sdf.corners.resize(total(corners));
    sample_lattice(sdf, corners, edge, 0, distance,
                   [&](std::size_t at, double value) { sdf.corners[at] = static_cast<float>(value); });

    const std::vector<double> middles = middles_of(sdf, sdf.bricks, distance);
    std::vector<std::size_t>  fine;
    sdf.slots.assign(middles.size(), -1);
    for (std::size_t at = 0; at < middles.size(); ++at)
    {
        if (std::abs(middles[at]) >= band + half_diagonal(sdf)) { continue; }
        sdf.slots[at] = static_cast<std::int32_t>(fine.size());
        fine.push_back(at);
    }
    require_room(sdf, static_cast<double>(fine.size()));
    sdf.values.resize(per_brick * fine.size());
#pragma omp parallel for schedule(dynamic, 4)
    for (std::size_t n = 0; n < fine.size(); ++n)
    {
        const double within = std::abs(middles[fine[n]]) + bit_more * half_diagonal(sdf);
        sample_brick(sdf, Brick(sdf, fine[n]), distance, within);
    }
#pragma omp parallel for schedule(static)
    for (std::size_t n = 0; n < fine.size(); ++n) { share_nodes(sdf, Brick(sdf, fine[n])); }
}

/// Negative volume of a brick, in cells, sampled for this purpose only.
double negative_cells(const SignedDistanceGrid& sdf, const Index3& brick, const SignedDistance& distance, double within)
{
    std::vector<double> values(per_brick);
    double              bound = within, cells = 0;
    for_each_node(
        [&](const Index3& node)
        {
            if (node[0] == 0) { bound = within; }
            double& value = values[index(node_counts, node)];
            value         = distance(
                        node_position(sdf, edge * brick[0] + node[0], edge * brick[1] + node[1], edge * brick[2] + node[2]),
                        bound);
            bound = std::abs(value) + bit_more * sdf.spacing;
        });
    for_each_node(
        [&](const Index3& node)
        {
            if (*std::max_element(node.begin(), node.end()) == edge) { return; }
            std::array<double, 8> corners;
            for (std::int32_t c = 0; c < 8; ++c)
            {
                corners[static_cast<std::size_t>(c)] =
                    values[index(node_counts, {node[0] + (c & 1), node[1] + ((c >> 1) & 1), node[2] + (c >> 2)})];
            }
            cells += cell_inside(corners);
        });
    return cells;
}

} // namespace

SignedDistanceGrid build_sdf(const Bounds& box, int cells, const SignedDistance& distance, double reach,
                             Storage storage)
{
    SignedDistanceGrid sdf   = grid_over(box, cells, reach);
    const bool         small = total(sdf.nodes) <= most_dense_nodes;
    if (storage == Storage::dense || (storage == Storage::by_size && small)) { fill_dense(sdf, distance); }
    else { fill_bricks(sdf, distance, reach); }
    return sdf;
}

double enclosed_volume_with(const Bounds& box, int cells, const SignedDistance& distance)
{
    const SignedDistanceGrid  sdf     = grid_over(box, cells);
    const Index3              bricks  = bricks_over(sdf);
    const std::vector<double> middles = middles_of(sdf, bricks, distance);
    std::vector<double>       parts(middles.size());
#pragma omp parallel for schedule(dynamic, 4)
    for (std::size_t at = 0; at < middles.size(); ++at)
    {
        const double magnitude = std::abs(middles[at]);
        if (magnitude >= bit_more * half_diagonal(sdf)) { parts[at] = middles[at] < 0 ? edge * edge * edge : 0; }
        else
        {
            parts[at] = negative_cells(sdf, place(bricks, at), distance, magnitude + bit_more * half_diagonal(sdf));
        }
    }
    double sum = 0;
    for (const double part : parts) { sum += part; }
    return sum * sdf.spacing * sdf.spacing * sdf.spacing;
}

} // namespace tread::shape
