#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "physics/harness.hpp"

// Sand is stable, or stopped with a diagnosis: never silently wrong.
namespace sand_step_test
{

using namespace tread;

/// Sand in a box of 0.4 m with cells of 0.05 m.
struct Case
{
    std::string name;
    std::string region   = "[[0.1, 0.1, 0.1], [0.3, 0.3, 0.4]]"; ///< a block that falls 0.1 m
    std::string points   = "points_per_cell = 8";
    std::string law      = "model = \"mohr-coulomb\"\nfriction_angle_deg = 30.0";
    double      young    = 1e6;
    double      poisson  = 0.3;
    double      share    = 1;   ///< of the automatic limit; exactly 1 = automatic
    double      longest  = 0.5; ///< s
    double      steps    = 300; ///< at the automatic limit, at most
    std::string transfer = "flip";
};

std::string text_of(const Case& c, const std::string& dt, double duration)
{
    return fmt::format(R"(
title = "{}"
[domain]
size    = [0.4, 0.4, 0.6]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.05
[time]
dt = {}
[numerics]
transfer = "{}"
[[material]]
name = "sand"
{}
density = 1600.0
young = {:e}
poisson = {}
[[terrain]]
material = "sand"
{}
region = {{ box = {} }}
[[phase]]
name = "fall"
duration = {:e}
)",
                       c.name, dt, c.transfer, c.law, c.young, c.poisson, c.points, c.region, duration);
}

struct Outcome
{
    bool         stopped = false;
    std::int64_t steps   = 0;
    double       largest = 0; ///< energy of the sand over its initial energy plus that of its deepest fall so far
    std::string  why;
};

/// Courant number c_p dt/h = courant of the scene's own solver.
template<class Exec, class Real>
double automatic_limit(const Exec& exec, const Case& c)
{
    const solver::PaceLimits limits =
        test::Experiment<Exec, Real>(exec, text_of(c, "\"auto\"", 1)).simulation().limits();
    return limits.courant * limits.spacing / limits.wave_speed;
}

template<class Real, class Exec>
Outcome outcome(const Exec& exec, const Case& c)
{
    const double                 limit    = automatic_limit<Exec, Real>(exec, c);
    const double                 duration = std::min(c.longest, c.steps * limit);
    const auto                   dt = c.share == 1 ? std::string("\"auto\"") : fmt::format("{:e}", c.share * limit);
    test::Experiment<Exec, Real> block(exec, text_of(c, dt, duration));
    const solver::Census         start = block.simulation().census();
    double                       gives = start.sand.strain;

    Outcome    out;
    const auto look = [&]
    {
        const solver::Census now = block.simulation().census();
        gives                    = std::max(gives, start.sand.strain + 9.81 * (start.sand.moment - now.sand.moment)[2]);
        const double held        = (now.sand.kinetic + now.sand.strain) / gives;
        out.largest              = std::isfinite(held) ? std::max(out.largest, held) : 1e300;
    };
    try
    {
        block.run(
            [&](double)
            {
                if (++out.steps % 5 == 0) { look(); }
            });
    }
    catch (const NumericalError& error)
    {
        out.stopped = true;
        out.why     = error.what();
    }
    look();
    std::cout << fmt::format("[ stability] {}, E = {:.0e} Pa, {}, {} x the limit: {} after {} steps, energy {:.3g}\n",
                             c.name, c.young, c.points, c.share, out.stopped ? "stopped" : "ran", out.steps,
                             out.largest);
    if (out.stopped) { std::cout << "    " << out.why << '\n'; }
    return out;
}

/// At or below the automatic limit. Twice the energy from gravity: symplectic steps let the energy of a mode oscillate
/// by (omega dt/2)^2 < 1 about its mean.
void expect_stable(const Outcome& out)
{
    EXPECT_FALSE(out.stopped);
    EXPECT_LT(out.largest, 2);
}

/// Above the limit: stopped before the energy is tenfold, or no larger than that.
void expect_no_silent_growth(const Outcome& out)
{
    EXPECT_LT(out.largest, 10);
    if (!out.stopped) { return; }
    EXPECT_NE(out.why.find("t = "), std::string::npos);
    EXPECT_NE(out.why.find("dt = "), std::string::npos);
    EXPECT_NE(out.why.find("Courant number"), std::string::npos);
}

const std::vector<Case>& kinds()
{
    static const std::vector<Case> kinds = {
        {.name = "falling block"},
        {.name = "bed at rest", .region = "[[0.0, 0.0, 0.0], [0.4, 0.4, 0.3]]"},
    };
    return kinds;
}

template<class Exec>
class SandStep : public test::BackendTest<Exec>
{
protected:
    /// Every kind at every stiffness and number of points per cell, at `share` of the limit.
    template<class Look>
    void each(double share, const Look& look)
    {
        for (Case c : kinds())
        {
            for (const int points : {1, 8, 27})
            {
                for (const double young : {1e4, 1e6, 1e8, 1e11})
                {
                    c.points = fmt::format("points_per_cell = {}", points);
                    c.young  = young;
                    c.share  = share;
                    SCOPED_TRACE(fmt::format("{}, E = {:g}, {} a cell, {} x", c.name, young, points, share));
                    look(outcome<float>(this->exec(), c));
                }
            }
        }
    }
};
TYPED_TEST_SUITE(SandStep, test::Backends, test::BackendNames);

TYPED_TEST(SandStep, StableAtHalfTheLimit) { this->each(0.5, expect_stable); }

TYPED_TEST(SandStep, StableAtNineTenthsOfTheLimit) { this->each(0.9, expect_stable); }

TYPED_TEST(SandStep, StableAtTheLimit) { this->each(1, expect_stable); }

TYPED_TEST(SandStep, StableOrStoppedAtOneAndAHalfTimesTheLimit) { this->each(1.5, expect_no_silent_growth); }

TYPED_TEST(SandStep, StableOrStoppedAtTwiceTheLimit) { this->each(2, expect_no_silent_growth); }

TYPED_TEST(SandStep, StoppedWithinAHundredStepsAtFourTimesTheLimit)
{
    this->each(4,
               [](const Outcome& out)
               {
                   expect_no_silent_growth(out);
                   EXPECT_TRUE(out.stopped);
                   EXPECT_LE(out.steps, 100);
               });
}

TYPED_TEST(SandStep, DoublePrecisionIsAsStable)
{
    for (Case c : kinds())
    {
        for (const double young : {1e4, 1e11})
        {
            c.young = young;
            SCOPED_TRACE(fmt::format("{}, E = {:g}", c.name, young));
            expect_stable(outcome<double>(this->exec(), c));
        }
    }
}

/// Nothing yields, so no generated energy is dissipated.
TYPED_TEST(SandStep, ElasticBlocks)
{
    for (const char* points : {"points_per_cell = 1", "points_per_cell = 8", "points_per_cell = 27"})
    {
        for (const double share : {1.0, 1.5, 2.0, 4.0})
        {
            for (Case c : kinds())
            {
                c.law    = "model = \"elastic\"";
                c.points = points;
                c.share  = share;
                SCOPED_TRACE(fmt::format("{}, {}, {} x", c.name, points, share));
                const Outcome out = outcome<float>(this->exec(), c);
                share > 1 ? expect_no_silent_growth(out) : expect_stable(out);
            }
        }
    }
}

TYPED_TEST(SandStep, LooseThinAndSteepSandIsStableAtTheAutomaticStep)
{
    const std::string layer = "[[0.0, 0.0, 0.1], [0.4, 0.4, 0.125]]", tower = "[[0.15, 0.15, 0.0], [0.25, 0.25, 0.5]]";
    const std::string half = "[[0.0, 0.0, 0.0], [0.4, 0.2, 0.3]]";
    for (const double young : {1e4, 1e6, 1e11})
    {
        for (Case c : {Case{.name = "loose points", .points = "spacing = 0.08"},
                       Case{.name = "one layer of points", .region = layer}, Case{.name = "tower", .region = tower},
                       Case{.name = "tower, one a cell", .region = tower, .points = "points_per_cell = 1"},
                       Case{.name = "steep face", .region = half, .points = "points_per_cell = 27"},
                       Case{.name = "nearly incompressible", .poisson = 0.499},
                       Case{.name = "affine velocities", .transfer = "apic"}})
        {
            c.young = young;
            SCOPED_TRACE(fmt::format("{}, E = {:g}", c.name, young));
            expect_stable(outcome<float>(this->exec(), c));
        }
    }
}

} // namespace sand_step_test
