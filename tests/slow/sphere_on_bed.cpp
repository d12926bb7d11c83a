#include <numbers>

#include "../physics/sphere_on_bed.hpp"

namespace
{

using namespace tread;

template<class Exec>
class SlowSphereOnBed : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(SlowSphereOnBed, test::Backends, test::BackendNames);

constexpr double mm = 1e-3;

test::SphereOnBed drum_on_bed()
{
    test::SphereOnBed bed;
    bed.form  = test::drum;
    bed.width = 0.22;
    bed.depth = 0.06;
    return bed;
}

/// docs/verification.md#body-at-rest-on-sand: the contact of a wheel at rest carries its weight, in every step, for any
/// number of substeps.
TYPED_TEST(SlowSphereOnBed, BedCarriesAWheelWhateverTheSubsteps)
{
    test::SphereOnBed bed = drum_on_bed();
    bed.settling          = 0.06;
    bed.free              = 0.015;
    test::expect_weight_carried(this->exec(), bed);
}

/// docs/verification.md#body-at-rest-on-sand, on sand, which comes to rest slowly.
TYPED_TEST(SlowSphereOnBed, SandCarriesAWheelWhateverTheSubsteps)
{
    test::SphereOnBed bed = drum_on_bed();
    bed.law               = "model = \"mohr-coulomb\"\nfriction_angle_deg = 35.0";
    bed.settling          = 0.55;
    bed.free              = 0.05;
    test::expect_weight_carried(this->exec(), bed);
}

/// A slope of 10 degrees, held by contact history, while sand is sorted in memory many times.
TYPED_TEST(SlowSphereOnBed, SphereStaysOnASlopeForTenSeconds)
{
    test::SphereOnBed bed;
    bed.spacing     = 0.02;
    bed.sideways    = std::tan(10 * std::numbers::pi / 180);
    bed.substeps    = 5;
    bed.settling    = 0.3;
    bed.free        = 10;
    const auto ball = test::watch_sphere(this->exec(), bed);
    const auto why  = fmt::format("0.01 mm in all, 1e-4 R; points were put in order {} times",
                                  this->counters.launches().at("list points"));
    test::report("creep on 10 degrees over 10 s, mm/s", ball.creep / mm, 0, 1e-3, why);
    test::report("what friction holds, over W", ball.pull, bed.sideways, 1e-3 * bed.sideways, "0.1 %: at rest");
    EXPECT_LT(std::abs(ball.creep), 1e-3 * mm);
    EXPECT_NEAR(ball.pull, bed.sideways, 1e-3 * bed.sideways);
    EXPECT_GT(this->counters.launches().at("list points"), 2);
}

/// Settlement of the bed's surface under the middle of the sphere, m: of the two uppermost layers of points beside the
/// axis, extrapolated by half a layer.
template<class Exec>
double sunk_under_the_middle(test::Experiment<Exec>& run, const test::SphereOnBed& bed)
{
    const auto&  points = run.simulation().sand().points();
    const auto   start = points.start.to_host(), now = points.position.to_host();
    const auto   n       = static_cast<std::size_t>(run.simulation().sand().count());
    const double lattice = bed.spacing / std::cbrt(bed.points_per_cell);
    const auto   lies    = [&](std::size_t i, double layer)
    {
        const double x = start[i] - 0.5 * bed.width, y = start[n + i] - 0.5 * bed.width;
        return std::hypot(x, y) < 0.75 * lattice && std::abs(start[2 * n + i] - layer) < 0.25 * lattice;
    };
    const auto sunk = [&](double layer)
    {
        double sum   = 0;
        int    count = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            if (!lies(i, layer)) { continue; }
            sum += start[2 * n + i] - now[2 * n + i];
            ++count;
        }
        return sum / count;
    };
    const double first = sunk(bed.depth - 0.5 * lattice), second = sunk(bed.depth - 1.5 * lattice);
    return first + 0.5 * (first - second);
}

/// Hertz's approach on a layer of thickness H bonded to its floor: the force is larger than on a half-space by 1 +
/// 0.881 chi + 0.776 chi^2 at nu = 0.3, chi = sqrt(R delta)/H (Dimitriadis et al. 2002, Biophys. J. 82:2798).
double approach_on_a_layer(double force, double effective_young, double radius, double depth)
{
    double delta = 0;
    for (int i = 0; i < 50; ++i)
    {
        const double chi   = std::sqrt(radius * delta) / depth;
        const double layer = 1 + 0.881 * chi + 0.776 * chi * chi;
        delta              = std::pow(0.75 * force / (layer * effective_young * std::sqrt(radius)), 2.0 / 3.0);
    }
    return delta;
}

struct Approach
{
    double measured, expected; ///< m
};

/// R = 0.2 m and 656.8 N on 10 MPa: the contact radius a is 20.8 mm. The bed is 20 a wide and 6 a deep, and heavy, so
/// that its waves are slow and the steps long; its stress at rest is that of its weight.
template<class Exec>
Approach approach(const Exec& exec, int cells, int points_per_cell)
{
    test::SphereOnBed bed;
    bed.young           = 1e7;
    bed.density         = 2e4;
    bed.radius          = 0.2;
    bed.weight          = 656.8;
    bed.friction        = 0;
    bed.substeps        = 1;
    bed.points_per_cell = points_per_cell;
    bed.width           = 0.42;
    bed.spacing         = bed.width / cells;
    bed.depth           = 0.3 * bed.width;
    bed.settling        = 0.1;
    bed.free            = 0.02;
    Approach   found{};
    const auto watched = test::watch_sphere<Exec>(
        exec, bed, [&](test::Experiment<Exec>& run) { found.measured = sunk_under_the_middle(run, bed); });
    found.expected = approach_on_a_layer(watched.lift * bed.weight, bed.young / (1 - 0.3 * 0.3), bed.radius, bed.depth);
    test::report(fmt::format("force over weight, {} cells, {} a cell", cells, points_per_cell), watched.lift, 1, 0.01,
                 "at rest");
    EXPECT_NEAR(watched.lift, 1, 0.01);
    return found;
}

/// docs/verification.md#sphere-on-an-elastic-bed: 10 % with cells of a third of a. With 1 point per cell the bed is
/// stiffer by its known half cell (a body acts as if 0.6 cells wider on every side: docs/accuracy.md, strip footings),
/// an error that scales with the cells; with 8 points it is not.
TYPED_TEST(SlowSphereOnBed, SinksIntoAnElasticBedAsHertzSays)
{
    const Approach eight = approach(this->exec(), 40, 8);
    test::report("approach in mm, 8 a cell, cells of a/2", eight.measured / mm, eight.expected / mm,
                 0.1 * eight.expected / mm, "docs/verification.md#sphere-on-an-elastic-bed");
    EXPECT_NEAR(eight.measured, eight.expected, 0.1 * eight.expected);

    const Approach half = approach(this->exec(), 40, 1), third = approach(this->exec(), 60, 1);
    const double   limit = 3 * third.measured / third.expected - 2 * half.measured / half.expected;
    test::report(fmt::format("approach over Hertz's, 1 a cell: {:.3f} with a/2, {:.3f} with a/3; extrapolated",
                             half.measured / half.expected, third.measured / third.expected),
                 limit, 1, 0.1, "D2, and the second order that is left");
    EXPECT_NEAR(limit, 1, 0.1);
}

} // namespace
