#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "energy_balance.hpp"

// Rotating matter neither swells nor slows down. Points move along straight lines, which increases their radius by a
// relative (angle per step)^2 / 2 in each step, and only the strain at the middle of the step accounts for it.
namespace
{

using namespace tread;

template<class Exec>
class Rotation : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Rotation, test::Backends, test::BackendNames);

constexpr double middle = 0.8; ///< m, of the axis along y of the rotation

/// An elastic body without weight, one cell thick; `shape`: lines of its terrain. `numerics`: lines of that table.
std::string turning_text(const std::string& shape, const std::string& numerics, double dt, double duration)
{
    return fmt::format(R"(
title = "turning body"
[domain]
size    = [1.6, 0.05, 1.6]
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "open", y = "slip", bottom = "open", top = "open" }}
[grid]
spacing = 0.05
[time]
dt = {}
[numerics]
precision = "double"
{}
[[material]]
name    = "soft"
model   = "elastic"
density = 1000.0
young   = 1.0e6
poisson = 0.3
[[terrain]]
material = "soft"
{}
[[phase]]
name     = "turn"
duration = {}
)",
                       dt, numerics, shape, duration);
}

const std::string square = "region = { box = [[0.4, 0.0, 0.4], [1.2, 0.05, 1.2]] }"; // of 16 x 16 cells
const std::string little = "region = { box = [[0.7, 0.0, 0.7], [0.9, 0.05, 0.9]] }"; // of 4 x 4 cells
const std::string disc   = "region = { box = [[0.6, 0.0, 0.6], [1.0, 0.05, 1.0]] }\n"
                           "height = \"0.8 + sqrt(max(0.04 - (x - 0.8)^2, 0))\"\n"
                           "floor  = \"0.8 - sqrt(max(0.04 - (x - 0.8)^2, 0))\"";

/// Starts the body's rotation at `rate` (1/s), without stress, and its ledger.
template<class Exec>
void set_turning(test::Experiment<Exec>& run, double rate)
{
    auto&             points = run.simulation().sand().points();
    const auto        x      = points.position.to_host();
    auto              v      = points.velocity.to_host();
    const std::size_t n      = x.size() / 3;
    for (std::size_t i = 0; i < n; ++i)
    {
        v[i]         = rate * (x[2 * n + i] - middle);
        v[2 * n + i] = -rate * (x[i] - middle);
    }
    points.velocity.assign(v);
    points.stress.fill_zero();
    run.simulation().ledger() = solver::Ledger({0, 0, 0}, run.simulation().census());
}

/// Moment of inertia about the axis, kg m2.
template<class Exec>
double inertia(test::Experiment<Exec>& run)
{
    auto&             points = run.simulation().sand().points();
    const auto        x = points.position.to_host(), m = points.mass.to_host();
    const std::size_t n     = m.size();
    double            total = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        const double dx = x[i] - middle, dz = x[2 * n + i] - middle;
        total += m[i] * (dx * dx + dz * dz);
    }
    return total;
}

/// At 1/s: with the strain at the start of the step the area would grow by rate^2 dt per second, 9.3e-3 in 19 s, and
/// the kinetic energy fall as much. The first second is left out, in which the transient of the unstressed start
/// decays. The little square uses APIC, because AFLIP's filter dissipates 1.5e-2 at the rim of so few cells.
TYPED_TEST(Rotation, SquareKeepsItsEnergyAndTheBalanceCloses)
{
    struct Case
    {
        const std::string& shape;
        const char*        numerics;
    };
    for (const Case& c :
         {Case{square, "transfer = \"aflip\""}, Case{little, "transfer = \"apic\"\nvolume_strain = \"cell-average\""}})
    {
        test::Experiment<TypeParam> run(this->exec(), turning_text(c.shape, c.numerics, 0x1p-11, 20));
        set_turning(run, 1);
        double start = 0;
        run.run(
            [&](double time)
            {
                if (start == 0 && time >= 1) { start = run.simulation().census().sand.kinetic; }
            });
        const solver::Census now = run.simulation().census();
        run.simulation().ledger().energy(now);
        const double lost = 1 - now.sand.kinetic / start, unaccounted = run.simulation().ledger().errors().energy;
        test::report(fmt::format("kinetic energy lost from 1 to 20 s, {}", c.numerics), lost, 0, 1e-3,
                     "a tenth of what the swelling of straight steps costs");
        test::report("unaccounted over the largest energy", unaccounted, 0, test::closes, "design 7");
        EXPECT_LE(std::abs(lost), 1e-3);
        EXPECT_NEAR(unaccounted, 0, test::closes);
    }
}

/// Two turns at 10/s. Straight steps alone would swell the inertia by 4 pi rate dt = 6.1e-2. Centrifugal force
/// stretches a disc in plane strain by u/r = (1 - nu) rho w^2 ((3 + nu) R^2 - (1 + nu) r^2) / (8 E), with E and nu of
/// plane strain (Timoshenko and Goodier 1970, 32); started without stress it oscillates about that.
TYPED_TEST(Rotation, SoftDiscKeepsItsInertia)
{
    const double                rate = 10, turn = 2 * std::numbers::pi / rate, nu = 0.3 / 0.7, young = 1e6 / 0.91;
    const double                pull           = (1 - nu) * 1000 * rate * rate * 0.2 * 0.2 / (8 * young);
    const double                inertia_growth = 2 * pull * (3 + nu - (1 + nu) * 2 / 3), volume_growth = 4 * pull;
    test::Experiment<TypeParam> run(this->exec(), turning_text(disc, "", 0x1p-11, 2 * turn));
    set_turning(run, rate);
    const double before = inertia(run);
    double       sum    = 0;
    int          steps  = 0;
    run.run(
        [&](double time)
        {
            if (time < turn) { return; }
            sum += inertia(run) / before - 1;
            ++steps;
        });
    const double growth = sum / steps;
    double       volume = 0, initial = 0;
    auto&        points = run.simulation().sand().points();
    const auto   ratio = points.volume_ratio.to_host(), parts = points.volume.to_host();
    for (std::size_t i = 0; i < ratio.size(); ++i)
    {
        volume += ratio[i] * parts[i];
        initial += parts[i];
    }
    test::report("growth of the inertia, mean of the second turn", growth, inertia_growth, 2e-3,
                 "issue: 2e-3, beside its own pull");
    test::report("growth of the volume after two turns", volume / initial - 1, volume_growth, 2e-3, "the same");
    EXPECT_NEAR(growth, inertia_growth, 2e-3);
    EXPECT_NEAR(volume / initial - 1, volume_growth, 2e-3);
}

} // namespace
