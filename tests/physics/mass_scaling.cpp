#include <algorithm>
#include <cmath>

#include "energy_balance.hpp"
#include "rock_rest.hpp"

// Rocks whose inertia is scaled up where their contacts want a shorter substep (docs/theory.md#mass-scaling).
namespace
{

using namespace tread;

template<class Exec>
class MassScaling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(MassScaling, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeMassScaling : public MassScaling<Exec>
{
};
TYPED_TEST_SUITE(FullSizeMassScaling, test::Backends, test::BackendNames);

std::string setting(double share, double mass_scaling)
{
    return fmt::format("[time]\ncontact_share = {}\nmass_scaling = {}\n", share, mass_scaling);
}

/// A bin three rocks of 10 mm wide, into which eighteen of them and three of 4 mm fall.
std::string two_sizes(double share, double mass_scaling, double friction, double restitution, int seed = 1)
{
    const auto rocks = [seed](int count, double diameter, double low, double high)
    {
        return fmt::format(R"(
[[rocks]]
shape = "bumpy"
material = "stone"
count = {}
diameter = {}
placement = "rain"
seed = {}
region = {{ box = [[0.0, 0.0, {}], [0.03, 0.03, {}]] }}
)",
                           count, diameter, seed, low, high);
    };
    return test::rock_domain({0.03, 0.03, 0.12}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"",
                             "linear_overlap = 1e-2") +
           setting(share, mass_scaling) + test::stone(1e7, friction, restitution) +
           "[[shape]]\nname = \"bumpy\"\ngenerate = { kind = \"rock\", seed = 5, nodes = 162 }\nsdf_cells = 40\n" +
           rocks(9, 0.01, 0.0, 0.03) + rocks(3, 0.004, 0.03, 0.04) + rocks(9, 0.01, 0.045, 0.08);
}

/// What beds took, and how they kept their balance.
struct Fallen
{
    double       unaccounted = 0; ///< largest share of the largest energy, mean of the beds
    std::int64_t substeps    = 0; ///< of all beds
};

template<class Exec>
Fallen fall(const Exec& exec, double share, double mass_scaling)
{
    constexpr double duration = 0.4;
    constexpr int    beds     = 3; // of 36 single ones 7 do not keep it better by their scaled inertia
    Fallen           found;
    for (int seed = 1; seed <= beds; ++seed)
    {
        test::Experiment<Exec> run(exec, two_sizes(share, mass_scaling, 0, 1, seed) + test::phase("fall", 0, duration));
        double                 unaccounted = 0;
        while (run.time() < duration)
        {
            found.substeps += run.advance().substeps;
            solver::Ledger& ledger = run.simulation().ledger();
            ledger.energy(run.simulation().census());
            unaccounted = std::max(unaccounted, std::abs(ledger.errors().energy));
        }
        found.unaccounted += unaccounted / beds;
    }
    return found;
}

/// Inertia of nine times lets substeps be three times as long. What it takes and gives back is accounted for.
TYPED_TEST(MassScaling, KeepsTheBalanceOfRocksThatFall)
{
    constexpr double share = 0.8 / 3, mass_scaling = 9;
    const double     longer = std::sqrt(mass_scaling);
    const Fallen     scaled = fall(this->exec(), share, mass_scaling), own = fall(this->exec(), share, 1),
                 bold = fall(this->exec(), longer * share, 1);
    test::report("substeps over those with their own inertia",
                 static_cast<double>(scaled.substeps) / static_cast<double>(own.substeps), 1 / longer, 0.1,
                 "1/sqrt(mass_scaling); rocks fall elsewhere");
    test::report("unaccounted over the largest energy, mean of three beds", scaled.unaccounted, 0, bold.unaccounted,
                 "less than with substeps as long and their own inertia; the step of a rock is the same share of its "
                 "contacts' time as without scaling");
    EXPECT_NEAR(static_cast<double>(scaled.substeps) / static_cast<double>(own.substeps), 1 / longer, 0.1);
    EXPECT_LT(scaled.unaccounted, bold.unaccounted);
}

TYPED_TEST(FullSizeMassScaling, RocksOfTwoSizesComeToRest)
{
    constexpr double damped = 2.6, left = 0.5; // as in rocks_rest.cpp
    test::expect_rest(this->exec(),
                      two_sizes(0.2, 9, 0.5, 0.5) + test::phase("settle", 0.3, damped) + test::phase("rest", 0, left),
                      damped, left);
}

/// What a second phase took.
struct SecondPhase
{
    std::int64_t substeps = 0;
    double       change   = 0; ///< J, of what scaled inertia has taken, in its second half
};

/// Rocks that fall with inertia of up to nine times, and go on for as long with that of up to `then` times.
/// `restitution` and `damping` of both phases.
template<class Exec>
SecondPhase fall_on(const Exec& exec, double then, double restitution, double damping)
{
    constexpr double       duration = 0.2;
    test::Experiment<Exec> run(exec, two_sizes(0.8 / 3, 9, 0, restitution) + test::phase("fall", damping, duration) +
                                         test::phase("on", damping, duration) +
                                         fmt::format("mass_scaling = {}\n", then));
    SecondPhase            second;
    std::int64_t           before  = 0;
    double                 at_half = 0, at_end = 0;
    run.run(
        [&](double time)
        {
            if (time < duration * (1 + 1e-9)) { before = run.substeps(); }
            at_end = run.simulation().ledger().energy(run.simulation().census()).mass_scaling;
            if (time < 1.5 * duration) { at_half = at_end; }
        });
    second.substeps = run.substeps() - before;
    second.change   = std::abs(at_end - at_half);
    return second;
}

/// In a phase with a scaling of 1 substeps are those of rocks with their own inertia: of rocks that lie, since those
/// that fly take as many either way.
TYPED_TEST(MassScaling, SubstepsEndWithItsPhase)
{
    const SecondPhase own = fall_on(this->exec(), 1, 0.2, 0.6), scaled = fall_on(this->exec(), 9, 0.2, 0.6);
    test::report("substeps over those with scaled inertia",
                 static_cast<double>(own.substeps) / static_cast<double>(scaled.substeps), 3, 0.9,
                 "sqrt(mass_scaling), as of those that fall");
    EXPECT_NEAR(static_cast<double>(own.substeps) / static_cast<double>(scaled.substeps), 3, 0.9);
}

/// What was scaled soon is no more in a phase with a scaling of 1.
TYPED_TEST(MassScaling, EndsWithItsPhase)
{
    const SecondPhase own = fall_on(this->exec(), 1, 1, 0), scaled = fall_on(this->exec(), 9, 1, 0);
    test::report("what scaled inertia takes at last, over what it takes where it goes on", own.change / scaled.change,
                 0, 1e-3, "0.99^1000 = 4e-5 of a factor's excess is left after 1,000 substeps");
    EXPECT_LT(own.change, 1e-3 * scaled.change);
}

/// Rocks that are balls, in a grid in the box [low, high].
std::string balls(int count, double diameter, const std::string& box)
{
    return fmt::format(R"(
[[shape]]
name = "ball"
generate = {{ kind = "sphere", nodes = 162 }}
sdf_cells = 24
[[rocks]]
shape = "ball"
material = "stone"
count = {}
diameter = {}
placement = "grid"
region = {{ box = {} }}
)",
                       count, diameter, box);
}

constexpr double whole_step = 1.0 / 2048; ///< s, of which steps add up without rounding

/// Two balls of 0.1 m that come to lie beside sand, with inertia of up to nine times for `steps`, then with their own.
std::string balls_beside_sand(int steps)
{
    return test::rock_domain({1, 0.4, 0.4}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"", "") +
           setting(0.2, 9) + fmt::format("dt = {}\n", whole_step) + test::stone(1e10, 0, 0.2) + test::sand_apart +
           balls(2, 0.1, "[[0.6, 0.1, 0.0], [0.9, 0.3, 0.12]]") + test::phase("settle", 0.6, steps * whole_step) +
           test::phase("lie", 0.6, 16 * whole_step) + "mass_scaling = 1\n";
}

/// Where all is quiet, steps of one length are not measured each. A phase with another scaling has its own substeps
/// from its first step on even if the last one was not.
TYPED_TEST(MassScaling, EndsBetweenMeasuredSteps)
{
    int unmeasured = 0;
    for (int steps = 1024; steps < 1030; ++steps)
    {
        test::Experiment<TypeParam> run(this->exec(), balls_beside_sand(steps));
        std::int64_t                before = 0, last = 0, first = 0;
        bool                        measured = true;
        run.run(
            [&](double time)
            {
                const std::int64_t substeps = run.substeps() - before;
                before                      = run.substeps();
                if (time <= steps * whole_step)
                {
                    last     = substeps;
                    measured = run.simulation().measured();
                }
                else if (first == 0) { first = substeps; }
            });
        unmeasured += measured ? 0 : 1;
        const double more = static_cast<double>(first) / static_cast<double>(last);
        test::report(fmt::format("substeps of the first step without scaling over the last one's with it, {} and {}",
                                 first, last),
                     more, 3, 1, "sqrt(mass_scaling), rounded up");
        EXPECT_NEAR(more, 3, 1);
    }
    EXPECT_GT(unmeasured, 0) << "else nothing was tested";
}

/// A ball of 2 cm that falls 5 cm onto a floor, without any loss.
std::string ball_that_falls(double share, double mass_scaling)
{
    return test::rock_domain({0.1, 0.1, 0.1}, 0, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", "") +
           setting(share, mass_scaling) + test::stone(1e7, 0, 1) +
           balls(1, 0.02, "[[0.03, 0.03, 0.05], [0.07, 0.07, 0.09]]") + test::phase("fall", 0, 0.2);
}

/// Inertia that has come stays while the ball is let go.
TYPED_TEST(MassScaling, AnElasticImpactKeepsItsSpeed)
{
    test::Experiment<TypeParam> run(this->exec(), ball_that_falls(0.2, 9));
    double                      down = 0, up = 0, given = 0;
    run.run(
        [&](double)
        {
            const solver::Census now = run.simulation().census();
            down                     = std::max(down, -now.rigid.momentum[2]);
            up                       = std::max(up, now.rigid.momentum[2]);
            given                    = std::max(given, -run.simulation().ledger().energy(now).mass_scaling);
        });
    const double fallen = 0.5 * down * down / run.simulation().census().rigid.mass;
    test::report("speed after over that before", up / down, 1, 0.02,
                 "0.2^2/4 of the energy of m f at either end, as AFaceThatArrivesAtOnceGainsNoEnergy");
    test::report("energy that scaled inertia brings to the impact, over the ball's", given / fallen, 4, 4,
                 "inertia up to nine times as large has up to eight times as much");
    EXPECT_NEAR(up / down, 1, 0.02);
    EXPECT_GT(given, 0.5 * fallen) << "else the inertia was hardly scaled";
    EXPECT_LT(given, 8 * fallen);
}

} // namespace
