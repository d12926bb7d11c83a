#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "backend.hpp"
#include "base/random.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/transfers/scatter.hpp"
#include "kernels/mpm/transfers/tile_kern.hpp"

// P2G node by node, on pages of few points and on full ones (the GPU has a kernel for each), against sums that are
// written out here from the formulas of docs/theory.md, with splines of their own.
namespace
{

using namespace tread;
using namespace tread::mpm;

const GridGeometry geometry{0.1, 0.5, Vec3<double>(1.6, 1.6, 1.6), {}};

using Node    = std::array<std::int64_t, 3>;
using Sums    = std::array<double, node_channels>;
using NodeMap = std::map<Node, Sums>;

/// Quadratic B-spline of a node at a distance of r spacings, and its slope over r.
double spline(double r)
{
    const double d = std::abs(r);
    return d < 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0.0;
}
double spline_slope(double r)
{
    const double d = std::abs(r);
    return d < 0.5 ? -2 * r : d < 1.5 ? (r > 0 ? d - 1.5 : 1.5 - d) : 0.0;
}

/// Random points in a cube of 0.4 to 1.2 m: 8 to 27 pages.
template<class Exec, class Real>
struct Cloud
{
    Cloud(const Exec& exec, std::int64_t count, PointFields fields)
        : points(exec)
        , pages(exec)
    {
        Random     random(11);
        const auto numbers = [&](std::int64_t n, double low, double high)
        {
            std::vector<double> values(static_cast<std::size_t>(n));
            for (double& value : values) { value = random.uniform(low, high); }
            return values;
        };
        const auto real = [&](const std::vector<double>& values)
        { return std::vector<Real>(values.begin(), values.end()); };
        points.allocate(count, fields);
        points.position.assign(numbers(3 * count, 0.4, 1.2));
        points.velocity.assign(real(numbers(3 * count, -1, 1)));
        points.stress.assign(real(numbers(6 * count, -1e4, 1e4)));
        points.mass.assign(real(numbers(count, 0.5, 2)));
        points.volume.assign(real(numbers(count, 1e-4, 1e-3)));
        points.volume_ratio.assign(real(numbers(count, 0.9, 1.1)));
        if (fields.affine) { points.affine.assign(real(numbers(9 * count, -20, 20))); }
        if (fields.coupled) { points.contact_force.assign(real(numbers(3 * count, -50, 50))); }
        OrderScratch<Exec, Real> scratch(exec);
        order_points(exec, points, pages, geometry, scratch);
    }

    /// What the formulas give every node.
    NodeMap expected() const
    {
        const auto   x = points.position.to_host();
        const auto   v = points.velocity.to_host(), s = points.stress.to_host(), m = points.mass.to_host();
        const auto   volume = points.volume.to_host(), c = points.affine.to_host(), f = points.contact_force.to_host();
        const auto   stride = static_cast<std::size_t>(points.stride);
        const double h      = geometry.spacing;
        NodeMap      sums;
        for (std::size_t p = 0; p < static_cast<std::size_t>(points.count); ++p)
        {
            Node low;
            for (std::size_t a = 0; a < 3; ++a) { low[a] = std::llround(x[a * stride + p] / h) - 1; }
            for (int n = 0; n < 27; ++n)
            {
                const Node node{low[0] + n % 3, low[1] + n / 3 % 3, low[2] + n / 9};
                double     w = 1, offset[3], weight[3], slope[3];
                for (std::size_t a = 0; a < 3; ++a)
                {
                    offset[a] = static_cast<double>(node[a]) * h - x[a * stride + p];
                    weight[a] = spline(offset[a] / h);
                    slope[a]  = -spline_slope(offset[a] / h) / h; // over the point's place
                    w *= weight[a];
                }
                const double      gradient[3] = {slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                                 weight[0] * weight[1] * slope[2]};
                const std::size_t row[3][3]   = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; // xx yy zz yz zx xy
                Sums&             sum         = sums[node];
                sum[0] += w * m[p];
                for (std::size_t a = 0; a < 3; ++a)
                {
                    double velocity = v[a * stride + p], force = f.empty() ? 0 : w * f[a * stride + p];
                    for (std::size_t b = 0; b < 3; ++b)
                    {
                        if (!c.empty()) { velocity += c[(3 * a + b) * stride + p] * offset[b]; }
                        force -= volume[p] * s[row[a][b] * stride + p] * gradient[b];
                    }
                    sum[1 + a] += w * m[p] * velocity;
                    sum[4 + a] += force;
                }
            }
        }
        return sums;
    }

    /// What P2G gives every node: the sum of the tiles that reach it.
    NodeMap scattered(const Exec& exec)
    {
        const PagesView   view = pages.view(geometry.spacing, geometry.stencil_shift);
        Array<Exec, Real> tiles(exec, "tiles", view.point_pages * node_channels * tile_nodes);
        tiles.fill_zero();
        scatter(exec, points.view(), view, all_point_pages(view), tiles.data());
        const std::vector<Real>          values = tiles.to_host();
        const std::vector<std::uint64_t> keys   = pages.point_page_key.to_host();
        NodeMap                          sums;
        for (std::size_t page = 0; page < keys.size(); ++page)
        {
            const Index3 at = page_coordinates(keys[page]);
            for (int place = 0; place < tile_nodes; ++place)
            {
                const int i = place % tile_edge, j = place / tile_edge % tile_edge, k = place / tile_edge / tile_edge;
                const TileSlot slot  = tile_slot(i, j, k);
                const auto     first = page * node_channels * tile_nodes + static_cast<std::size_t>(slot.first);
                Sums&          sum   = sums[{page_edge * at.x + i, page_edge * at.y + j, page_edge * at.z + k}];
                for (std::size_t channel = 0; channel < node_channels; ++channel)
                {
                    sum[channel] += values[first + channel * static_cast<std::size_t>(slot.stride)];
                }
            }
        }
        return sums;
    }

    Points<Exec, Real> points;
    Pages<Exec>        pages;
};

/// Largest difference of a channel over its largest value; infinite where a node has no finite sum.
Sums largest_differences(const NodeMap& found, NodeMap expected)
{
    Sums worst{}, largest{};
    for (const auto& [node, sum] : found) { expected[node]; }
    for (const auto& [node, sum] : expected)
    {
        const auto at = found.find(node);
        for (std::size_t channel = 0; channel < node_channels; ++channel)
        {
            const double here = at == found.end() ? 0.0 : at->second[channel];
            const double off  = std::abs(here - sum[channel]);
            worst[channel] =
                std::isfinite(off) ? std::max(worst[channel], off) : std::numeric_limits<double>::infinity();
            largest[channel] = std::max(largest[channel], std::abs(sum[channel]));
        }
    }
    for (std::size_t channel = 0; channel < node_channels; ++channel) { worst[channel] /= largest[channel]; }
    return worst;
}

template<class Exec>
class ScatterTest : public test::BackendTest<Exec>
{
protected:
    /// All combinations of affine velocities and contact forces.
    template<class Real>
    void expect_formulas(std::int64_t count, double tolerance)
    {
        for (const bool affine : {false, true})
        {
            for (const bool coupled : {false, true})
            {
                Cloud<Exec, Real> cloud(this->exec(), count, {.affine = affine, .plastic = false, .coupled = coupled});
                const Sums        off = largest_differences(cloud.scattered(this->exec()), cloud.expected());
                for (std::size_t channel = 0; channel < node_channels; ++channel)
                {
                    EXPECT_LE(off[channel], tolerance)
                        << "channel " << channel << ", affine " << affine << ", coupled " << coupled;
                }
            }
        }
    }
};
TYPED_TEST_SUITE(ScatterTest, test::Backends, test::BackendNames);

// Tolerances: rounding of sums of some hundreds of terms.
TYPED_TEST(ScatterTest, SparsePagesGiveNodesWhatTheFormulasSay)
{
    this->template expect_formulas<double>(300, 1e-13);
    this->template expect_formulas<float>(300, 2e-6);
}

TYPED_TEST(ScatterTest, FullPagesGiveNodesWhatTheFormulasSay)
{
    this->template expect_formulas<double>(12000, 1e-13);
    this->template expect_formulas<float>(12000, 5e-6);
}

} // namespace
