#include <array>
#include <cmath>
#include <map>
#include <set>

#include "backend.hpp"
#include "base/random.hpp"
#include "kernels/mpm/grid/held_pages.hpp"
#include "kernels/mpm/grid/held_pages_kern.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/transfers/scatter.hpp"

namespace
{

using namespace tread;
using namespace tread::mpm;

constexpr double spacing = 0.1, dt = 1e-3;

/// Nodes of page (0, 0, 0) reached by the cells of the page at `octant` below it, found by walking through stencils.
std::set<int> reached_from(int octant)
{
    std::set<int> places;
    const Index3  from{-(octant & 1), -(octant >> 1 & 1), -(octant >> 2)};
    for (int cell = 0; cell < page_cells; ++cell)
    {
        const Index3 lowest = node_at(from, cell);
        for (int n = 0; n < 27; ++n)
        {
            const Index3 node{lowest.x + n % 3, lowest.y + n / 3 % 3, lowest.z + n / 9};
            const Index3 of = page_of(node);
            if (of.x == 0 && of.y == 0 && of.z == 0) { places.insert(place_in_page(node)); }
        }
    }
    return places;
}

TEST(HeldNodes, AreThoseThatSleepingPointsReach)
{
    for (int octant = 0; octant < octants; ++octant)
    {
        const std::set<int> reached = reached_from(octant);
        for (int place = 0; place < page_cells; ++place)
        {
            EXPECT_EQ(is_held(1U << octant, place), reached.count(place) == 1) << "octant " << octant;
        }
    }
    EXPECT_FALSE(is_held(0, 0));
}

/// The grid of points, two of whose pages sleep.
template<class Exec>
struct HeldGrid
{
    HeldGrid(const Exec& exec, Points<Exec, double>& points)
        : pages(exec)
        , tiles(exec, "tiles")
        , motion(exec, "motion")
        , tallies(exec, "tallies")
        , held(exec)
    {
        OrderScratch<Exec, double> scratch(exec);
        order_points(exec, points, pages, {spacing, 0.5, {2, 2, 2}}, scratch);
        view = pages.view(spacing, 0.5);
        tiles.resize(view.point_pages * node_channels * tile_nodes);
        motion.resize(view.node_pages * motion_channels * page_cells);
        tallies.resize(view.node_pages * tally_width(grid_sums));
        tallies.fill_zero();
        Array<Exec, std::uint64_t> asleep(exec, "asleep");
        asleep.assign({page_key({1, 2, 2}), page_key({2, 2, 2})});
        list_held_pages(exec, view, asleep, held, scratch.sort);
        scatter(exec, points.view(), view, all_point_pages(view), tiles.data());
    }

    void update(const Exec& exec, const SharedPagesView<double>& shared)
    {
        update_grid(exec, view, WallPagesView<double>{}, shared, tiles.data(), step, motion.data(), tallies.data());
    }

    void hold(const Exec& exec, const SharedPagesView<double>& shared)
    {
        hold_still(exec, view, held.view(), shared, tiles.data(), step, motion.data(), tallies.data());
    }

    GridStep<double>    step{dt, {0.3, 0, -9.81}, 0, 1e-20, {}};
    Pages<Exec>         pages;
    PagesView           view{};
    Array<Exec, double> tiles, motion, tallies;
    HeldPages<Exec>     held;
};

template<class Exec>
class HeldPagesTest : public test::BackendTest<Exec>
{
protected:
    /// Random points, with velocity and stress, in a box of some 5 x 5 x 5 pages.
    Points<Exec, double> points()
    {
        constexpr std::int64_t count = 4000;
        Points<Exec, double>   points(this->exec());
        points.allocate(count, {});
        Random     random(5);
        const auto numbers = [&](std::int64_t n, double low, double high)
        {
            std::vector<double> values;
            for (std::int64_t i = 0; i < n; ++i) { values.push_back(random.uniform(low, high)); }
            return values;
        };
        points.position.assign(numbers(3 * count, 0.1, 1.9));
        points.velocity.assign(numbers(3 * count, -1, 1));
        points.stress.assign(numbers(6 * count, -1e3, 1e3));
        points.mass.assign(numbers(count, 1, 2));
        points.volume.assign(numbers(count, 1e-4, 2e-4));
        return points;
    }

    /// Masses (kg) of the nodes that points reach, from stencils one point after the other.
    std::map<std::array<int, 3>, double> node_masses(const Points<Exec, double>& points)
    {
        const auto                           x = points.position.to_host(), mass = points.mass.to_host();
        const auto                           s = static_cast<std::size_t>(points.stride);
        std::map<std::array<int, 3>, double> nodes;
        for (std::size_t i = 0; i < static_cast<std::size_t>(points.count); ++i)
        {
            const Vec3<double> at(x[i], x[s + i], x[2 * s + i]);
            const Lattice      lattice = make_lattice(spacing, 0.5);
            const auto         stencil = stencil_above<double>(cell_of(at, lattice), at, 1 / spacing, lattice);
            for (int n = 0; n < 27; ++n)
            {
                const int a = n % 3, b = n / 3 % 3, c = n / 9;
                nodes[{stencil.base.x + a, stencil.base.y + b, stencil.base.z + c}] +=
                    mass[i] * stencil.weight[0][a] * stencil.weight[1][b] * stencil.weight[2][c];
            }
        }
        return nodes;
    }
};
TYPED_TEST_SUITE(HeldPagesTest, test::Backends, test::BackendNames);

/// A free grid in the air, so that the ledger contains only gravity, stress and the holding forces.
TYPED_TEST(HeldPagesTest, StopTheNodesAndBookIt)
{
    const auto                exec   = this->exec();
    Points<TypeParam, double> points = this->points();
    HeldGrid<TypeParam>       grid(exec, points);
    const GridStep<double>&   step = grid.step;
    EXPECT_EQ(grid.held.page.size(), 12); // two adjacent pages and the upper neighbours of both
    grid.update(exec, {});
    const auto free = grid.motion.to_host();
    grid.hold(exec, {});
    const auto still = grid.motion.to_host(), sums = grid.tallies.to_host();

    const auto   keys = grid.pages.node_page_key.to_host();
    const auto   mass = this->node_masses(points);
    Vec3<double> impulse(Vec3<double>::Zero());
    double       expected[grid_sums] = {};
    for (std::size_t page = 0; page < keys.size(); ++page)
    {
        for (int place = 0; place < page_cells; ++place)
        {
            const Index3 node  = node_at(page_coordinates(keys[page]), place);
            const bool   stops = node.x >= 4 && node.x < 14 && node.y >= 8 && node.y < 14 && node.z >= 8 && node.z < 14;
            const auto   of    = [&](const std::vector<double>& motions, int channel)
            {
                Vec3<double> value;
                for (int c = 0; c < 3; ++c)
                {
                    value[c] = motions[(page * motion_channels + static_cast<std::size_t>(channel + c)) * page_cells +
                                       static_cast<std::size_t>(place)];
                }
                return value;
            };
            const Vec3<double> moved = of(free, 0), before = moved - of(free, 3);
            const Vec3<double> after = stops ? Vec3<double>(Vec3<double>::Zero()) : moved;
            EXPECT_EQ(of(still, 0), after);
            EXPECT_LT((of(still, 3) - (after - before)).norm(), 1e-12);
            const auto found = mass.find({node.x, node.y, node.z});
            if (found == mass.end()) { continue; }
            const double       m      = found->second;
            const Vec3<double> weight = m * step.gravity;
            expected[grid_kinetic_before] += 0.5 * m * before.squaredNorm();
            expected[grid_kinetic_after] += 0.5 * m * after.squaredNorm();
            expected[grid_gravity_power] += weight.dot(after);
            expected[grid_gravity_work] += 0.5 * dt * weight.dot(before + after);
            expected[grid_net_force] += m * (after - before).norm() / dt;
            if (stops)
            {
                expected[grid_wall_loss] += 0.5 * m * moved.dot(before);
                impulse -= m * moved;
            }
        }
    }
    for (int c = 0; c < 3; ++c) { expected[grid_wall_impulse + c] = impulse[c]; }

    const auto given = grid.held.impulse.to_host();
    for (std::size_t i = 0; i < given.size(); ++i) { impulse[static_cast<int>(i % 3)] -= given[i]; }
    EXPECT_LT(impulse.norm(), 1e-9);
    for (const int which :
         {+grid_kinetic_before, +grid_kinetic_after, +grid_gravity_power, +grid_gravity_work, +grid_net_force,
          +grid_wall_loss, +grid_wall_impulse, grid_wall_impulse + 1, grid_wall_impulse + 2})
    {
        double of_steps = 0, of_last = 0;
        for (std::size_t page = 0; page < keys.size(); ++page)
        {
            of_steps += sums[page * tally_width(grid_sums) + static_cast<std::size_t>(which)];
            of_last += sums[page * tally_width(grid_sums) + static_cast<std::size_t>(grid_sums + which)];
        }
        EXPECT_NE(of_steps, 0) << which;
        EXPECT_EQ(of_steps, of_last) << which;
        EXPECT_NEAR(of_steps, expected[which], 1e-10 * std::abs(expected[which])) << which;
    }
}

/// Another process brings as much to one of the pages as this one: it takes twice the impulse to hold it.
TYPED_TEST(HeldPagesTest, HoldTheTotalsOfSharedPages)
{
    const auto                exec   = this->exec();
    Points<TypeParam, double> points = this->points();
    HeldGrid<TypeParam>       alone(exec, points), together(exec, points);
    alone.update(exec, {});
    alone.hold(exec, {});

    SharedPages<TypeParam, double> shared(exec);
    const std::int32_t             page = alone.held.page.to_host()[0];
    std::vector<std::int32_t>      number_of(static_cast<std::size_t>(alone.view.node_pages), -1);
    number_of[static_cast<std::size_t>(page)] = 0;
    shared.page.assign({page});
    shared.number_of.assign(number_of);
    shared.own.resize(node_page_values);
    sum_own_parts(exec, together.view, together.tiles.data(), shared);
    std::vector<double> twice = shared.own.to_host();
    for (double& value : twice) { value *= 2; }
    shared.total.assign(twice);
    together.update(exec, shared.view());
    together.hold(exec, shared.view());

    EXPECT_EQ(alone.motion.to_host(), together.motion.to_host());
    const auto one = alone.held.impulse.to_host(), both = together.held.impulse.to_host();
    EXPECT_NE(one[2], 0);
    for (std::size_t i = 0; i < one.size(); ++i) { EXPECT_EQ(both[i], (i < 3 ? 2 : 1) * one[i]) << i; }
}

TYPED_TEST(HeldPagesTest, KeepTheLargestSpeedOfSteps)
{
    const auto               exec = this->exec();
    Array<TypeParam, double> peaks(exec, "peaks"), largest(exec, "largest");
    peaks.assign({4, 1, 0.5, 0, 9, 3});
    largest.assign({1, 1, 16});
    keep_largest_speeds(exec, 3, peaks.data(), largest.data());
    EXPECT_EQ(largest.to_host(), (std::vector<double>{4, 1, 16}));
}

} // namespace
