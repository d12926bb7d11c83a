#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "backend.hpp"
#include "base/random.hpp"
#include "kernels/mpm/grid/grid.hpp"
#include "kernels/mpm/grid/seams.hpp"
#include "kernels/mpm/grid/seams_kern.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/pages/relist.hpp"
#include "kernels/mpm/transfers/gather.hpp"
#include "kernels/mpm/transfers/scatter.hpp"

namespace mpm_seams_test
{

using namespace tread;
using namespace tread::mpm;

constexpr double       spacing = 0.1;
constexpr std::int64_t count   = 6000;

/// A cube of random points refined by two boxes, with all arrays of a step.
template<class Exec>
struct RefinedCube
{
    /// Points lie between `low` and `high` along every axis, m.
    explicit RefinedCube(const Exec& backend, double low = 0.2, double high = 4)
        : exec(backend)
        , points(exec)
        , pages(exec)
        , scratch(exec)
        , seams(exec)
        , tiles(exec, "tiles")
        , motion(exec, "motion")
        , grid_rows(exec, "grid rows")
        , point_rows(exec, "point rows")
        , peaks(exec, "peaks")
        , materials(exec, "materials")
        , to(exec, "to", count)
        , counts(exec, "counts")
        , changed_in(exec, "stirred in", 1)
    {
        const std::int32_t one = level_offset(1) * page_edge, two = level_offset(2) * page_edge;
        geometry.refinement.levels = 2;
        geometry.refinement.box[0] = {{one + 12, one + 14, one + 10}, {one + 50, one + 52, one + 60}};
        geometry.refinement.box[1] = {{two + 40, two + 42, two + 36}, {two + 80, two + 84, two + 70}};
        fill(low, high);
        order_points(exec, points, pages, geometry, scratch);
        tiles.resize(pages.point_page_key.size() * node_channels * tile_nodes);
        tiles.fill_zero();
        motion.resize(pages.node_page_key.size() * motion_channels * page_cells);
        motion.fill_zero();
        grid_rows.resize(pages.node_page_key.size() * tally_width(grid_sums));
        grid_rows.fill_zero();
        point_rows.resize(pages.point_page_key.size() * tally_width(point_sums));
        point_rows.fill_zero();
        peaks.resize(pages.point_page_key.size() * point_peaks);
        peaks.fill_zero();
        counts.resize(pages.point_page_key.size() * move_counts);
        changed_in.assign({-1});
        materials.assign({make_material(make_elasticity<double>(1e6, 0.3, 1600))});
        list_seams(exec, view(), geometry.refinement, seams, scratch.sort);
    }

    void fill(double low, double high)
    {
        Random random(7);
        points.allocate(count, {.affine = true, .plastic = false, .coupled = false});
        std::vector<double> x(3 * count), v(3 * count), m(count), ones(count, 1.0), volume(count), stress(6 * count);
        for (double& value : x) { value = random.uniform(low, high); }
        for (double& value : v) { value = random.uniform(-1, 1); }
        for (double& value : m) { value = random.uniform(0.5, 2); }
        for (double& value : volume) { value = random.uniform(1e-4, 1e-3); }
        for (double& value : stress) { value = random.uniform(-1e4, 1e4); }
        points.position.assign(x);
        points.velocity.assign(v);
        points.mass.assign(m);
        points.volume.assign(volume);
        points.volume_ratio.assign(ones);
        points.stress.assign(stress);
    }

    PagesView view() const { return pages.view(geometry.lattice(), geometry.refinement.levels); }

    template<class Launch>
    void for_each_level(const Launch& launch)
    {
        for (int level = 0; level <= geometry.refinement.levels; ++level)
        {
            launch(on_level(view(), geometry.refinement, level), seams.point_pages(level));
        }
    }

    void bring_to_nodes(double dt)
    {
        for_each_level([&](const PagesView& level, const PageList& list)
                       { scatter(exec, points.view(), level, list, tiles.data()); });
        hand_down(exec, view(), geometry.refinement, tiles.data(), seams);
        GridStep<double> step{dt, Vec3<double>::Zero(), 0, 0, {}};
        for (auto& axis : step.walls.rule)
        {
            for (WallRule& rule : axis) { rule = WallRule::open; }
        }
        update_grid(exec, view(), WallPagesView<double>{}, seams.view(), tiles.data(), step, motion.data(),
                    grid_rows.data());
        follow_coarser(exec, view(), geometry.refinement, seams, motion.data());
    }

    /// APIC: sets the points' velocity and gradient from the nodes.
    void take_from_nodes(double dt)
    {
        const MovesView moves{to.data(), counts.data(), changed_in.data(), 0};
        for_each_level(
            [&](const PagesView& level, const PageList& list)
            {
                gather(exec, points.view(), level, list, motion.data(),
                       GatherStep<double>{dt, materials.data(), 1.0, nullptr}, moves, point_rows.data(), peaks.data());
            });
    }

    /// Sum over pages of one column of rows.
    double sum(const Array<Exec, double>& rows, int width, int which) const
    {
        const std::vector<double> all = rows.to_host();
        double                    sum = 0;
        for (std::size_t i = static_cast<std::size_t>(which); i < all.size(); i += static_cast<std::size_t>(width))
        {
            sum += all[i];
        }
        return sum;
    }

    Exec                                    exec;
    GridGeometry                            geometry{spacing, 0.5, {4.2, 4.2, 4.2}, {}};
    Points<Exec, double>                    points;
    Pages<Exec>                             pages;
    OrderScratch<Exec, double>              scratch;
    Seams<Exec, double>                     seams;
    Array<Exec, double>                     tiles, motion, grid_rows, point_rows, peaks;
    Array<Exec, MaterialParameters<double>> materials;
    Array<Exec, std::uint16_t>              to;
    Array<Exec, std::int32_t>               counts;
    Array<Exec, std::int64_t>               changed_in;
};

template<class Exec>
class SeamsTest : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(SeamsTest, test::Backends, test::BackendNames);

/// Every free node gets the velocity of a linear field at its position, and slave nodes arbitrary values: after the
/// slave nodes are tied, all points see the field and its gradient.
TYPED_TEST(SeamsTest, PointsSeeALinearFieldExactly)
{
    RefinedCube<TypeParam> cube(this->exec());
    Mat3<double>           gradient;
    gradient << 0.1, -0.5, 0.3, 0.7, 0.2, -0.4, -0.6, 0.35, 0.15;
    const Vec3<double>               offset(0.3, -0.2, 0.5);
    const std::vector<std::uint64_t> keys = cube.pages.node_page_key.to_host();
    std::vector<double>              motion(keys.size() * motion_channels * page_cells, 0.0);
    int                              slaves = 0;
    for (std::size_t page = 0; page < keys.size(); ++page)
    {
        const Index3  at      = page_coordinates(keys[page]);
        const int     level   = level_of(at);
        const Lattice lattice = level_lattice(cube.geometry.lattice(), level);
        for (int place = 0; place < page_cells; ++place)
        {
            const Index3       node = node_at(at, place);
            const bool         free = !is_slave(cube.geometry.refinement, level, node);
            const Vec3<double> x =
                lattice.spacing * (Vec3<double>(node.x, node.y, node.z) + Vec3<double>::Constant(lattice.node_shift));
            const Vec3<double> v = free ? Vec3<double>(offset + gradient * x) : Vec3<double>::Constant(1e3);
            slaves += !free;
            for (std::size_t c = 0; c < 3; ++c)
            {
                motion[(page * motion_channels + c) * page_cells + static_cast<std::size_t>(place)] =
                    v[static_cast<Eigen::Index>(c)];
            }
        }
    }
    ASSERT_GT(slaves, 1000);
    cube.motion.assign(motion);
    follow_coarser(cube.exec, cube.view(), cube.geometry.refinement, cube.seams, cube.motion.data());
    const std::vector<double> x = cube.points.position.to_host();
    cube.take_from_nodes(1e-6);
    const std::vector<double> v = cube.points.velocity.to_host(), affine = cube.points.affine.to_host();
    const auto                stride = static_cast<std::size_t>(cube.points.stride);
    double                    worst = 0, worst_gradient = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    {
        const Vec3<double> expected = offset + gradient * Vec3<double>(x[i], x[stride + i], x[2 * stride + i]);
        for (std::size_t c = 0; c < 3; ++c)
        {
            const auto row = static_cast<Eigen::Index>(c);
            worst          = std::max(worst, std::abs(v[c * stride + i] - expected[row]));
            for (std::size_t d = 0; d < 3; ++d)
            {
                worst_gradient = std::max(worst_gradient, std::abs(affine[(3 * c + d) * stride + i] -
                                                                   gradient(row, static_cast<Eigen::Index>(d))));
            }
        }
    }
    std::cout << "velocity off by " << worst << ", gradient by " << worst_gradient
              << "; tolerances 1e-13, 1e-12 (rounding, and that over a cell's width)\n";
    EXPECT_LT(worst, 1e-13);
    EXPECT_LT(worst_gradient, 1e-12);
}

/// With one velocity for all points the grid's kinetic energy equals that of the points if mass and momentum do.
TYPED_TEST(SeamsTest, NodesHoldTheMassOfThePoints)
{
    RefinedCube<TypeParam> cube(this->exec());
    const auto             stride = static_cast<std::size_t>(cube.points.stride);
    std::vector<double>    v(3 * stride, 0.0);
    std::fill_n(v.begin(), stride, 2.0);
    cube.points.velocity.assign(v);
    cube.points.stress.fill_zero();
    cube.bring_to_nodes(1e-3);
    double mass = 0;
    for (const double m : cube.points.mass.to_host()) { mass += m; }
    const double kinetic = cube.sum(cube.grid_rows, tally_width(grid_sums), grid_kinetic_before);
    EXPECT_NEAR(kinetic, 2 * mass, 1e-9 * mass);
    EXPECT_NEAR(cube.sum(cube.grid_rows, tally_width(grid_sums), grid_net_force), 0, 1e-9 * mass);
}

/// A block with free faces across both boxes translates as one.
TYPED_TEST(SeamsTest, OneVelocityStaysOneVelocity)
{
    for (const auto& [low, high] : {std::pair(0.3, 1.2), std::pair(0.9, 1.9), std::pair(2.2, 3.3)})
    {
        RefinedCube<TypeParam> cube(this->exec(), low, high);
        const auto             stride = static_cast<std::size_t>(cube.points.stride);
        std::vector<double>    v(3 * stride, 0.0);
        std::fill_n(v.begin(), stride, 2.0);
        cube.points.velocity.assign(v);
        cube.points.stress.fill_zero();
        cube.bring_to_nodes(1e-3);
        cube.take_from_nodes(1e-3);
        v            = cube.points.velocity.to_host();
        double worst = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        {
            worst = std::max(worst, std::abs(v[i] - 2));
        }
        EXPECT_LT(worst, 1e-12) << "block from " << low << " to " << high << " m";
    }
}

/// The work of the nodal forces of stress on any velocity equals the points' stress power: the energy balances of grid
/// and points agree, level by level and across the seams.
TYPED_TEST(SeamsTest, WorkOfStressIsTheSameOnBothSides)
{
    RefinedCube<TypeParam> cube(this->exec());
    constexpr double       dt = 1e-20; // so short that neither stress nor velocity changes, even at light nodes
    cube.bring_to_nodes(dt);
    const double force_power = cube.sum(cube.grid_rows, tally_width(grid_sums), grid_power_before);
    cube.take_from_nodes(dt);
    const double stress_power = cube.sum(cube.point_rows, tally_width(point_sums), point_stress_power);
    std::cout << "power of forces " << force_power << " W, of stress " << stress_power << " W\n";
    EXPECT_NEAR(force_power, -stress_power, 1e-12 * std::abs(stress_power));
}

/// A point that has left the box sees the field of a point of the level below.
TYPED_TEST(SeamsTest, SlaveNodesOutsideTheBoxAreTheCoarseField)
{
    RefinedCube<TypeParam> cube(this->exec());
    cube.bring_to_nodes(1e-3);
    const std::vector<double>        motion   = cube.motion.to_host();
    const std::vector<std::uint64_t> keys     = cube.pages.node_page_key.to_host();
    const auto                       velocity = [&](int level, const Vec3<double>& x)
    {
        const Lattice lattice = level_lattice(cube.geometry.lattice(), level);
        const Index3  cell    = cell_of(x, lattice);
        const auto    stencil = stencil_above<double>(cell, x, lattice.inverse_spacing, lattice);
        double        sum     = 0;
        for (int n = 0; n < 27; ++n)
        {
            const Index3 node{cell.x + n % 3, cell.y + n / 3 % 3, cell.z + n / 9};
            const auto   at = std::lower_bound(keys.begin(), keys.end(), page_key(page_of(node)));
            EXPECT_TRUE(at != keys.end() && *at == page_key(page_of(node)));
            const auto page = static_cast<std::size_t>(at - keys.begin());
            sum += stencil.weight[0][n % 3] * stencil.weight[1][n / 3 % 3] * stencil.weight[2][n / 9] *
                   motion[page * motion_channels * page_cells + static_cast<std::size_t>(place_in_page(node))];
        }
        return sum;
    };
    // The box of level 1 begins at 13 of its knots, 0.65 m, along x.
    for (const double x : {0.649, 0.63, 0.6})
    {
        const Vec3<double> at(x, 1.7, 1.9);
        EXPECT_NEAR(velocity(1, at), velocity(0, at), 1e-13) << x;
        EXPECT_NE(velocity(0, at), 0);
    }
}

} // namespace mpm_seams_test
