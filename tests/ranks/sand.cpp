#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include <fmt/format.h>

#include "decomp/combine.hpp"
#include "kernels/mpm/pages/far_cells.hpp"
#include "rank_run.hpp"

// Sand on several ranks compared with the same sand on one. Ranks add shared contributions in another order than one
// rank does, so results agree to rounding; the set of points, their ids and masses agree exactly.
namespace
{

using namespace tread;

constexpr int steps = 200;

/// Parts of a scene that differ between tests.
struct SandScene
{
    std::string title, domain, young, box;
    std::string cohesion = "0.0";
};

std::string text_of(const SandScene& scene)
{
    return fmt::format(R"(
title = "{}"
[domain]
{}
[grid]
spacing = 0.02
[numerics]
precision = "double"
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = {}
poisson = 0.3
friction_angle_deg = 31.0
cohesion = {}
[[terrain]]
material = "sand"
region = {{ box = {} }}
[[phase]]
name = "{}"
duration = 1.0
)",
                       scene.title, scene.domain, scene.young, scene.cohesion, scene.box, scene.title);
}

/// A column that collapses across pages of 0.08 m; all kinds of walls.
std::string column_text()
{
    return text_of({"collapse", R"(
size    = [0.48, 0.14, 0.28]
gravity = [0.0, 0.0, -9.81]
walls   = { x = "slip", y = "frictional", bottom = "fixed", top = "slip", friction = 0.3 }
)",
                    "1.0e6", "[[0.0, 0.0, 0.0], [0.16, 0.14, 0.24]]"});
}

/// A block that flies along x through many pages.
std::string flight_text()
{
    return text_of({"flight", R"(
size    = [1.2, 0.16, 0.16]
gravity = [30.0, 0.0, 0.0]
walls   = { x = "slip", y = "slip", bottom = "slip", top = "slip" }
)",
                    "3.0e5", "[[0.02, 0.04, 0.04], [0.14, 0.12, 0.12]]", "100.0"});
}

/// A small ball that is held at a place: sand may touch it, and so points stay near their pages.
std::string ball_text(const Vec3<double>& position)
{
    return test::soft_steel_text + fmt::format(R"(
[[shape]]
name      = "ball"
generate  = {{ kind = "sphere", nodes = 42 }}
sdf_cells = 16
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.008
density  = 7800.0
position = [{}, {}, {}]
lock     = ["x", "y", "z", "roll", "pitch", "yaw"]
)",
                                               position[0], position[1], position[2]);
}

/// Keeps the owners that a test assigns.
const std::string owners_stay = "[balance]\nthreshold = 1e6\n";

/// Divides a load of any size, on a GPU as well.
const std::string any_load = "[balance]\nleast_load = 0\n";

template<class Exec>
class RankSand : public test::BackendTest<Exec>
{
protected:
    using Run = test::RankRun<Exec, double>;

    /// Checks the largest differences of this rank's points, and of the energy balance, from those of a run on one
    /// rank.
    void expect_agreement(Run& all, Run& alone, double rounding)
    {
        const io::PointFields    own = all.points(), reference = alone.points();
        std::vector<std::size_t> place(reference.id.size());
        for (std::size_t i = 0; i < place.size(); ++i) { place[reference.id[i]] = i; }
        double position = 0, velocity = 0;
        for (std::size_t i = 0; i < own.id.size(); ++i)
        {
            const std::size_t other = place[own.id[i]];
            for (std::size_t c = 0; c < 3; ++c)
            {
                position = std::max(position, std::abs(own.position[3 * i + c] - reference.position[3 * other + c]));
                velocity = std::max(velocity, static_cast<double>(std::abs(own.velocity[3 * i + c] -
                                                                           reference.velocity[3 * other + c])));
            }
        }
        const auto energy = all.energy(), expected = alone.energy();
        std::cout << fmt::format("[ ranks    ] rank {} of {}: {} points, positions differ by {:.2g} m, velocities by "
                                 "{:.2g} m/s; plastic work {:.10g} J, alone {:.10g} J\n",
                                 test::world().rank(), test::world().size(), own.id.size(), position, velocity,
                                 energy.plastic, expected.plastic);
        EXPECT_LT(position, rounding);
        EXPECT_LT(velocity, 1e-6); // fp32 in the snapshot
        EXPECT_NEAR(energy.kinetic_points, expected.kinetic_points, 1e-9 * expected.kinetic_points);
        EXPECT_NEAR(energy.plastic, expected.plastic, 1e-9 * std::abs(expected.plastic));
        EXPECT_NEAR(energy.friction, expected.friction, 1e-9 * std::abs(expected.friction));
        EXPECT_NEAR(energy.transfer, expected.transfer, 1e-7 * std::abs(expected.transfer) + 1e-12);
        EXPECT_NEAR(energy.total, expected.total, 1e-10 * std::abs(expected.total));
        expect_all_points(own, reference);
        expect_balance(all, alone);
    }

    /// Spacings: how far this rank's points are outside the pages that it owns, at most.
    static double farthest_outside_in(Run& run)
    {
        const mpm::PageLattice lattice  = solver::page_lattice_of(run.scene_world());
        const double           edge     = mpm::page_edge * lattice.spacing;
        const io::PointFields  points   = run.points();
        double                 farthest = 0;
        for (std::size_t i = 0; i < points.id.size(); ++i)
        {
            const Vec3<double> at(points.position.data() + 3 * i);
            const mpm::Index3  page    = mpm::page_at(lattice, at);
            double             nearest = edge;
            for (int direction = 0; direction < mpm::directions; ++direction)
            {
                const mpm::Index3 other = mpm::page_towards(page, direction);
                if (run.owners().owner(mpm::page_key(other)) != test::world().rank()) { continue; }
                const Vec3<double> low = edge * Vec3<double>(other.x, other.y, other.z) +
                                         Vec3<double>::Constant(lattice.stencil_shift * lattice.spacing);
                const Vec3<double> inside = at.cwiseMax(low).cwiseMin(low + Vec3<double>::Constant(edge));
                nearest                   = std::min(nearest, (at - inside).norm());
            }
            farthest = std::max(farthest, nearest);
        }
        return farthest / lattice.spacing;
    }

    /// Checks momentum in kg m/s, of some 10 N over 0.1 s. One rank accounts for the impulse of the walls.
    void expect_balance(Run& all, Run& alone)
    {
        const solver::Census together = all.simulation().census(), expected = alone.simulation().census();
        EXPECT_NEAR(together.sand.mass, expected.sand.mass, 1e-13 * expected.sand.mass);
        for (int c = 0; c < 3; ++c) { EXPECT_NEAR(together.sand.momentum[c], expected.sand.momentum[c], 1e-10); }
        EXPECT_LT(all.simulation().ledger().balance(together).impulse_error, 1e-12);
    }

    /// Checks that every point of the scene is on exactly one rank.
    void expect_all_points(const io::PointFields& own, const io::PointFields& reference)
    {
        std::vector<std::int32_t> ids(own.id.begin(), own.id.end());
        ids = test::world().gather(ids);
        EXPECT_EQ(ids.size(), reference.id.size());
        EXPECT_EQ(std::set<std::int32_t>(ids.begin(), ids.end()).size(), reference.id.size());
    }
};

TYPED_TEST_SUITE(RankSand, test::Backends, test::BackendNames);

// 200 steps of a sum of some 1e3 terms: 1e-12 m is four orders above the observed error, and eight below the motion.
constexpr double rounding = 1e-12;

TYPED_TEST(RankSand, ColumnCollapsesAsOnOneRank)
{
    typename TestFixture::Run all(this->exec(), column_text(), test::Ranks::all);
    typename TestFixture::Run alone(this->exec(), column_text(), test::Ranks::this_one);
    all.step(steps);
    alone.step(steps);
    EXPECT_EQ(all.time(), alone.time());
    this->expect_agreement(all, alone, rounding);
}

TYPED_TEST(RankSand, PagesMayBelongToAnyRank)
{
    const auto scattered = [](mpm::Index3 page) { return (7 * page.x + 5 * page.y + 3 * page.z + 64) % 11; };
    typename TestFixture::Run all(this->exec(), column_text() + owners_stay, test::Ranks::all, scattered);
    typename TestFixture::Run alone(this->exec(), column_text(), test::Ranks::this_one);
    all.step(steps);
    alone.step(steps);
    this->expect_agreement(all, alone, rounding);
}

TYPED_TEST(RankSand, IsTheSameEveryTime)
{
    io::PointFields first;
    for (int run = 0; run < 2; ++run)
    {
        typename TestFixture::Run all(this->exec(), column_text(), test::Ranks::all);
        all.step(100);
        const io::PointFields found = all.points();
        if (run == 0) { first = found; }
        EXPECT_EQ(found.id, first.id);
        EXPECT_EQ(found.position, first.position);
        EXPECT_EQ(found.velocity, first.velocity);
        EXPECT_EQ(found.stress, first.stress);
    }
}

TYPED_TEST(RankSand, IsTheSameByEveryTransport)
{
    typename TestFixture::Run any(this->exec(), column_text(), test::Ranks::all);
    typename TestFixture::Run host(this->exec(), column_text(), test::Ranks::all, {},
                                   {decomp::TransportChoice::host, decomp::Checksums::on});
    std::cout << fmt::format("[ ranks    ] '{}' against '{}'\n", any.transport().description(),
                             host.transport().description());
    any.step(50);
    host.step(50);
    EXPECT_EQ(any.points().position, host.points().position);
    EXPECT_EQ(any.points().stress, host.points().stress);
}

/// Rank after rank receives the block and loses it again.
TYPED_TEST(RankSand, RanksBecomeEmptyAndFillAgain)
{
    const auto                slabs = [](mpm::Index3 page) { return (page.x + 2) / 2; };
    typename TestFixture::Run all(this->exec(), flight_text() + owners_stay, test::Ranks::all, slabs);
    typename TestFixture::Run alone(this->exec(), flight_text(), test::Ranks::this_one);
    const std::int64_t        before = all.simulation().points();
    int                       empty = 0, full = 0;
    for (int part = 0; part < 20; ++part)
    {
        all.step(20);
        alone.step(20);
        (all.simulation().points() == 0 ? empty : full) += 1;
    }
    std::cout << fmt::format("[ ranks    ] rank {}: {} points at first, then {} times some, {} times none\n",
                             test::world().rank(), before, full, empty);
    this->expect_agreement(all, alone, rounding);
    EXPECT_GT(full, 0);
    if (test::world().size() > 1) { EXPECT_GT(empty, 0); }
}

/// With a body that they may touch points are sorted before they are two spacings outside the pages of their rank.
TYPED_TEST(RankSand, PointsStayNearTheirPagesWhereThereAreBodies)
{
    const auto                slabs    = [](mpm::Index3 page) { return (page.x + 2) / 2; };
    const std::string         far_ball = ball_text({1.18, 0.14, 0.14});
    typename TestFixture::Run with_ball(this->exec(), flight_text() + far_ball + owners_stay, test::Ranks::all, slabs);
    typename TestFixture::Run alone(this->exec(), flight_text() + owners_stay, test::Ranks::all, slabs);
    double                    outside[] = {0, 0};
    for (int step = 0; step < 300; ++step)
    {
        with_ball.step(1);
        alone.step(1);
        outside[0] = std::max(outside[0], this->farthest_outside_in(with_ball));
        outside[1] = std::max(outside[1], this->farthest_outside_in(alone));
    }
    decomp::combine(test::world(), outside, 0, 2);
    const auto [near, far] = outside;
    std::cout << fmt::format(
        "[ ranks    ] points were up to {:.2f} spacings outside the pages of their rank; without a "
        "body {:.2f}\n",
        near, far);
    EXPECT_LT(near, mpm::farthest_outside);
    if (test::world().size() > 1)
    {
        EXPECT_GT(near, 0);
        EXPECT_GT(far, mpm::farthest_outside) << "the limit never mattered";
    }
}

/// A ball 0.9 spacings beyond the border between two ranks, which only sand of the other rank that has left its pages
/// meets.
TYPED_TEST(RankSand, FlyingPointsMeetABallBesideTheBorder)
{
    const auto                slabs = [](mpm::Index3 page) { return (page.x + 2) / 2; };
    const std::string         text  = flight_text() + ball_text({0.17 + 0.9 * 0.02 + 0.004, 0.08, 0.08});
    typename TestFixture::Run all(this->exec(), text + owners_stay, test::Ranks::all, slabs);
    typename TestFixture::Run alone(this->exec(), text + owners_stay, test::Ranks::this_one);
    double                    force = 0, difference = 0;
    for (int step = 0; step < 150; ++step)
    {
        all.step(1);
        alone.step(1);
        const Vec3<double> expected = alone.simulation().named_bodies()[0].force;
        force                       = std::max(force, expected.norm());
        difference = std::max(difference, (all.simulation().named_bodies()[0].force - expected).norm());
    }
    std::cout << fmt::format(
        "[ ranks    ] the ball is pushed with up to {:.4g} N, and {:.2g} N differently on one rank\n", force,
        difference);
    EXPECT_GT(force, 0);
    EXPECT_LT(difference, 1e-9 * force)
        << "sums in another order; a quarter is missing where no rank lets its points touch the ball";
}

TYPED_TEST(RankSand, ARankMayHaveNothing)
{
    const auto                first_only = [](mpm::Index3) { return 0; };
    typename TestFixture::Run all(this->exec(), column_text() + owners_stay, test::Ranks::all, first_only);
    typename TestFixture::Run alone(this->exec(), column_text(), test::Ranks::this_one);
    all.step(50);
    alone.step(50);
    EXPECT_EQ(all.simulation().points() == 0, test::world().rank() > 0);
    this->expect_agreement(all, alone, rounding);
}

TYPED_TEST(RankSand, PagesAreDealtOutAnewWhereThatPays)
{
    const auto                first_only = [](mpm::Index3) { return 0; };
    typename TestFixture::Run all(this->exec(), column_text() + any_load, test::Ranks::all, first_only);
    typename TestFixture::Run alone(this->exec(), column_text(), test::Ranks::this_one);
    EXPECT_EQ(all.simulation().balance()->imbalance, test::world().size());
    all.step(steps);
    alone.step(steps);
    const decomp::BalanceRow& found = *all.simulation().balance();
    std::cout << fmt::format("[ ranks    ] imbalance {:.3f} after {} repartitions, {} points moved\n", found.imbalance,
                             found.repartitions, found.points_moved);
    EXPECT_EQ(found.repartitions, test::world().size() > 1 ? 1 : 0);
    EXPECT_LT(found.imbalance, 1.15);
    this->expect_agreement(all, alone, rounding);
}

/// Pages without an owner are assigned alike on all ranks.
TYPED_TEST(RankSand, NewPagesGetOneOwner)
{
    typename TestFixture::Run all(this->exec(), flight_text(), test::Ranks::all);
    typename TestFixture::Run alone(this->exec(), flight_text(), test::Ranks::this_one);
    all.step(300);
    alone.step(300);
    this->expect_agreement(all, alone, rounding);
}

} // namespace
