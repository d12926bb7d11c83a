#include <algorithm>
#include <cmath>
#include <set>

#include "backend.hpp"
#include "base/random.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/pages/relist.hpp"
#include "kernels/mpm/transfers/gather.hpp"
#include "kernels/mpm/transfers/scatter.hpp"
#include "kernels/mpm/transfers/scatter_kern.hpp"

namespace
{

using namespace tread;
using namespace tread::mpm;

TEST(PageKey, RoundTripsAndOrdersNegativeCoordinates)
{
    for (const Index3 page : {Index3{0, 0, 0}, Index3{-1, 2, -3}, Index3{1000, -200000, 262143}, Index3{-262144, 5, 9}})
    {
        const Index3 back = page_coordinates(page_key(page));
        EXPECT_EQ(back.x, page.x);
        EXPECT_EQ(back.y, page.y);
        EXPECT_EQ(back.z, page.z);
    }
    EXPECT_LT(cell_key({0, 0, 0}), cell_key({1, 0, 0}));
    EXPECT_EQ(cell_key({-1, 0, 0}) >> 6, page_key({-1, 0, 0}));
    EXPECT_LT(cell_key({262143 * 4, 262143 * 4, 262143 * 4}), no_page);
}

/// Checks sum of weights 1, sum of slopes 0 and the first moment at the point, to the rounding of the type
/// (docs/verification.md#rotation-and-translation).
template<class Real>
void expect_partition_of_unity(double shift, double tolerance)
{
    Random random(3);
    double worst_sum = 0, worst_slope = 0, worst_moment = 0;
    for (int trial = 0; trial < 10000; ++trial)
    {
        const double       spacing = 0.025;
        const Lattice      lattice = make_lattice(spacing, shift);
        const Vec3<double> x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const auto         stencil = stencil_above<Real>(cell_of(x, lattice), x, 1 / spacing, lattice);
        for (int axis = 0; axis < 3; ++axis)
        {
            double sum = 0, slope = 0, moment = 0;
            for (int node = 0; node < 3; ++node)
            {
                EXPECT_GE(stencil.weight[axis][node], 0);
                sum += double(stencil.weight[axis][node]);
                slope += double(stencil.slope[axis][node]) * spacing;
                moment += double(stencil.weight[axis][node]) * (node - double(stencil.fraction[axis]));
            }
            worst_sum    = std::max(worst_sum, std::abs(sum - 1));
            worst_slope  = std::max(worst_slope, std::abs(slope));
            worst_moment = std::max(worst_moment, std::abs(moment));
        }
    }
    std::cout << "partition of unity, shift " << shift << ": |sum - 1| " << worst_sum << ", |sum of slopes| h "
              << worst_slope << ", |moment| / h " << worst_moment << "; tolerance " << tolerance
              << " (a few roundings of the type)\n";
    EXPECT_LT(worst_sum, tolerance);
    EXPECT_LT(worst_slope, tolerance);
    EXPECT_LT(worst_moment, tolerance);
}

TEST(Stencil, QuadraticIsAPartitionOfUnityInDouble) { expect_partition_of_unity<double>(0.5, 2e-14); }
TEST(Stencil, QuadraticIsAPartitionOfUnityInSingle) { expect_partition_of_unity<float>(0.5, 1e-6); }
TEST(Stencil, LinearIsAPartitionOfUnity) { expect_partition_of_unity<double>(0.0, 2e-14); }

template<class Exec>
class PagesTest : public test::BackendTest<Exec>
{
protected:
    static constexpr double spacing = 0.1;

    /// Random points in a box that includes negative coordinates; mass i + 1 and id i identify them.
    Points<Exec, double> random_points(std::int64_t count)
    {
        Points<Exec, double> points(this->exec());
        points.allocate(count, {});
        Random                     random(11);
        std::vector<double>        position(static_cast<std::size_t>(3 * count)), mass, velocity;
        std::vector<std::uint32_t> id;
        for (double& x : position) { x = random.uniform(-0.15, 2.0); }
        for (std::int64_t i = 0; i < count; ++i)
        {
            mass.push_back(double(i + 1));
            id.push_back(static_cast<std::uint32_t>(i));
        }
        for (std::int64_t i = 0; i < 3 * count; ++i) { velocity.push_back(random.uniform(-1, 1)); }
        points.position.assign(position);
        points.mass.assign(mass);
        points.id.assign(id);
        points.velocity.assign(velocity);
        return points;
    }

    /// Checks that every point is listed once, in the range of a cell that may contain it.
    void expect_listed(const Points<Exec, double>& points, const Pages<Exec>& pages, std::int64_t count)
    {
        const auto first = pages.first_point.to_host(), cells = pages.cell_first_point.to_host();
        const auto list  = pages.point_at.to_host();
        const auto place = pages.place_at.to_host();
        const auto keys  = pages.point_page_key.to_host();
        const auto x     = points.position.to_host();
        const auto s     = static_cast<std::size_t>(points.stride);
        ASSERT_EQ(first.back(), count);
        std::set<std::int32_t> seen;
        int                    misplaced = 0;
        for (std::size_t page = 0; page < keys.size(); ++page)
        {
            EXPECT_EQ(cells[page * page_cells], first[page]);
            for (std::int32_t at = first[page]; at < first[page + 1]; ++at)
            {
                const auto   k    = static_cast<std::size_t>(list[static_cast<std::size_t>(at)]);
                const auto   here = place[static_cast<std::size_t>(at)];
                const Index3 cell = node_at(page_coordinates(keys[page]), here);
                const auto   of   = page * page_cells + here;
                misplaced += !stays_in(cell, {x[k], x[s + k], x[2 * s + k]}, make_lattice(spacing, 0.5)) ||
                             at < cells[of] || at >= cells[of + 1];
                seen.insert(list[static_cast<std::size_t>(at)]);
            }
        }
        EXPECT_EQ(misplaced, 0);
        EXPECT_EQ(static_cast<std::int64_t>(seen.size()), count);
    }

    GridGeometry geometry{spacing, 0.5, {2, 2, 2}};
};

TYPED_TEST_SUITE(PagesTest, test::Backends, test::BackendNames);

TYPED_TEST(PagesTest, EveryPointStandsInTheRangeOfItsCell)
{
    auto                            points = this->random_points(5000);
    Pages<TypeParam>                pages(this->exec());
    OrderScratch<TypeParam, double> scratch(this->exec());
    order_points(this->exec(), points, pages, this->geometry, scratch);
    const auto         first = pages.first_point.to_host(), cells = pages.cell_first_point.to_host();
    const auto         keys = pages.point_page_key.to_host();
    const auto         x = points.position.to_host(), mass = points.mass.to_host();
    const auto         id = points.id.to_host();
    const std::int64_t n  = points.count;
    ASSERT_EQ(n, 5000);
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
    std::set<std::uint32_t> seen;
    for (std::size_t page = 0; page < keys.size(); ++page)
    {
        for (std::int32_t i = first[page]; i < first[page + 1]; ++i)
        {
            const auto   k    = static_cast<std::size_t>(i);
            const auto   s    = static_cast<std::size_t>(points.stride);
            const Index3 cell = cell_of({x[k], x[s + k], x[2 * s + k]}, make_lattice(this->spacing, 0.5));
            EXPECT_EQ(page_key(page_of(cell)), keys[page]);
            const auto at = page * page_cells + static_cast<std::size_t>(place_in_page(cell));
            EXPECT_GE(i, cells[at]);
            EXPECT_LT(i, cells[at + 1]);
            EXPECT_EQ(mass[k], double(id[k] + 1)); // fields are permuted together
            seen.insert(id[k]);
        }
    }
    EXPECT_EQ(seen.size(), 5000u);
}

TYPED_TEST(PagesTest, NeighbourTablesAgreeBothWays)
{
    auto                            points = this->random_points(300);
    Pages<TypeParam>                pages(this->exec());
    OrderScratch<TypeParam, double> scratch(this->exec());
    order_points(this->exec(), points, pages, this->geometry, scratch);
    const auto              point_key = pages.point_page_key.to_host(), node_key = pages.node_page_key.to_host();
    const auto              node_of = pages.node_page_of.to_host(), point_of = pages.point_page_of.to_host();
    std::set<std::uint64_t> wanted;
    for (std::size_t p = 0; p < point_key.size(); ++p)
    {
        for (std::size_t o = 0; o < 8; ++o)
        {
            Index3 page = page_coordinates(point_key[p]);
            page        = {page.x + int(o & 1), page.y + int(o >> 1 & 1), page.z + int(o >> 2)};
            wanted.insert(page_key(page));
            const auto node_page = static_cast<std::size_t>(node_of[8 * p + o]);
            EXPECT_EQ(node_key[node_page], page_key(page));
            EXPECT_EQ(point_of[8 * node_page + o], static_cast<std::int32_t>(p));
        }
    }
    EXPECT_EQ(std::vector<std::uint64_t>(wanted.begin(), wanted.end()), node_key);
}

/// Points drift through several pages at a uniform grid velocity; after every step each is listed in its cell, though
/// no point moves in memory.
TYPED_TEST(PagesTest, RelistedPointsStandInTheRangesOfTheirCells)
{
    constexpr std::int64_t count = 3000;
    constexpr double       dt = 0.01, speed = 2.9; // 0.29 of a spacing a step
    auto                   points = this->random_points(count);
    points.volume_ratio.assign(std::vector<double>(count, 1.0));
    auto start = points.position.to_host();
    for (double& x : start) { x += 1; } // clear of the walls, beyond which there are no pages
    points.position.assign(start);
    Pages<TypeParam>                pages(this->exec());
    OrderScratch<TypeParam, double> order_scratch(this->exec());
    RelistScratch<TypeParam>        scratch(this->exec());
    Array<TypeParam, std::uint64_t> room(this->exec(), "room");
    order_points(this->exec(), points, pages, GridGeometry{this->spacing, 0.5, {4, 4, 4}}, order_scratch);
    start = points.position.to_host();

    Array<TypeParam, MaterialParameters<double>> materials(this->exec(), "materials");
    materials.assign({make_material(make_elasticity<double>(1e6, 0.3, 1600))});
    const std::int64_t       page_count = pages.point_page_key.size(), node_pages = pages.node_page_key.size();
    Array<TypeParam, double> motion(this->exec(), "motion"),
        sums(this->exec(), "sums", page_count * tally_width(point_sums)),
        peaks(this->exec(), "peaks", page_count * point_peaks);
    std::vector<double> uniform(static_cast<std::size_t>(node_pages * motion_channels * page_cells), 0.0);
    for (std::size_t i = 0; i < uniform.size(); ++i)
    {
        uniform[i] = i / page_cells % motion_channels < 3 ? (i / page_cells % 2 == 0 ? speed : -speed) : 0.0;
    }
    motion.assign(uniform);
    Array<TypeParam, std::uint16_t> to(this->exec(), "to", count);
    Array<TypeParam, std::int32_t>  counts(this->exec(), "counts", page_count * move_counts);
    Array<TypeParam, std::int64_t>  changed_in(this->exec(), "stirred in", 1);
    changed_in.assign({-1});

    for (int step = 0; step < 6; ++step) // 1.7 spacings: within the listed pages
    {
        const MovesView moves{to.data(), counts.data(), changed_in.data(), step};
        sums.fill_zero();
        peaks.fill_zero();
        const PagesView view = pages.view(this->spacing, 0.5);
        gather(this->exec(), points.view(), view, all_point_pages(view), motion.data(),
               GatherStep<double>{dt, materials.data(), 0.0, nullptr}, moves, sums.data(), peaks.data());
        double     worst = 0;
        const auto rows  = peaks.to_host();
        for (std::size_t row = 0; row < rows.size(); row += point_peaks)
        {
            worst = std::max(worst, rows[row + peak_cell_change]);
        }
        ASSERT_GE(worst, static_cast<double>(CellChange::moved)) << "step " << step;
        ASSERT_LE(worst, static_cast<double>(CellChange::rim)) << "step " << step;
        relist_points(this->exec(), pages, moves, scratch, room);
        this->expect_listed(points, pages, count);
    }
    EXPECT_NEAR(points.position.to_host()[0], start[0] + 6 * dt * speed, 1e-12); // at the same index in memory
}

TYPED_TEST(PagesTest, PointsFarOutsideAreDropped)
{
    auto points = this->random_points(100);
    auto x      = points.position.to_host();
    x[7]        = 50;  // beyond a side wall
    x[208]      = -30; // below the bottom: third plane
    points.position.assign(x);
    Pages<TypeParam>                pages(this->exec());
    OrderScratch<TypeParam, double> scratch(this->exec());
    order_points(this->exec(), points, pages, this->geometry, scratch);
    EXPECT_EQ(points.count, 98);
    const auto id = points.id.to_host();
    EXPECT_EQ(std::count(id.begin(), id.begin() + 98, 7u), 0);
    EXPECT_EQ(std::count(id.begin(), id.begin() + 98, 8u), 0);
}

TYPED_TEST(PagesTest, ScatterKeepsMassMomentumAndForceFree)
{
    auto points = this->random_points(2000);
    points.stress.assign(std::vector<double>(12000, -1e5));
    points.volume.assign(std::vector<double>(2000, 1e-4));
    points.volume_ratio.assign(std::vector<double>(2000, 1.0));
    Pages<TypeParam>                pages(this->exec());
    OrderScratch<TypeParam, double> scratch(this->exec());
    order_points(this->exec(), points, pages, this->geometry, scratch);
    const std::int64_t       page_count = pages.point_page_key.size();
    Array<TypeParam, double> tiles(this->exec(), "tiles", page_count * node_channels * tile_nodes);
    tiles.fill_zero(); // tiles of pages without points are not written
    const PagesView view = pages.view(this->spacing, 0.5);
    scatter(this->exec(), points.view(), view, all_point_pages(view), tiles.data());
    const auto values                = tiles.to_host();
    double     totals[node_channels] = {};
    const auto for_each_value        = [&](auto visit)
    {
        for (std::int64_t at = 0; at < page_count * tile_nodes * node_channels; ++at)
        {
            const auto node    = static_cast<int>(at / node_channels % tile_nodes),
                       channel = static_cast<int>(at % node_channels);
            const TileSlot slot =
                tile_slot(node % tile_edge, node / tile_edge % tile_edge, node / (tile_edge * tile_edge));
            const auto page = at / (tile_nodes * node_channels);
            visit(channel, values[static_cast<std::size_t>(page * tile_nodes * node_channels + slot.first +
                                                           channel * slot.stride)]);
        }
    };
    for_each_value([&](int channel, double value) { totals[channel] += value; });
    double     mass = 0, momentum[3] = {}, largest_force = 0;
    const auto m = points.mass.to_host(), v = points.velocity.to_host();
    for (std::size_t i = 0; i < 2000; ++i)
    {
        mass += m[i];
        for (std::size_t c = 0; c < 3; ++c) { momentum[c] += m[i] * v[c * 2000 + i]; }
    }
    for_each_value(
        [&](int channel, double value)
        {
            if (channel >= 4) { largest_force = std::max(largest_force, std::abs(value)); }
        });
    std::cout << "scatter: mass error " << std::abs(totals[0] / mass - 1) << ", internal force sum " << totals[4]
              << " of nodes up to " << largest_force << "; tolerance 1e-12 (rounding of 54,000 shares)\n";
    EXPECT_NEAR(totals[0] / mass, 1, 1e-12);
    for (int c = 0; c < 3; ++c)
    {
        EXPECT_NEAR(totals[1 + c], momentum[c], 1e-12 * mass);
        EXPECT_NEAR(totals[4 + c], 0, 1e-10 * largest_force); // an isolated stress field exerts no net force
    }
}

} // namespace
