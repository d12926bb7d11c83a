#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "solver/ledger/sand_guard.hpp"

namespace
{

using namespace tread;
using namespace tread::solver;

/// Stored energy that oscillates between kinetic and strain energy and grows by the factor `growth` in each step;
/// `steps` steps are reported at once.
class Swing
{
public:
    Swing(double growth, int steps)
        : growth_(growth)
        , steps_(steps)
    {
    }

    SandReport next()
    {
        const double before = kinetic();
        for (int i = 0; i < steps_; ++i)
        {
            energy_ *= growth_;
            phase_ += 0.1;
        }
        SandReport report;
        report.steps                           = steps_;
        report.last_points[mpm::point_kinetic] = kinetic();
        report.last_points[mpm::point_strain]  = energy_ - kinetic();
        report.grid[mpm::grid_kinetic_before]  = before;
        report.grid[mpm::grid_kinetic_after]   = kinetic();
        return report;
    }

    double energy() const { return energy_; }

private:
    double kinetic() const { return energy_ * std::pow(std::sin(phase_), 2); }

    double growth_;
    int    steps_;
    double energy_ = 1e-3, phase_ = 0;
};

/// Growth of the energy until the alarm, infinite if there is none in 20000 steps.
double growth_at_alarm(double growth, int steps)
{
    Swing       swing(growth, steps);
    EnergyWatch watch(1.0, 10.0);
    watch.add(swing.next(), 1e-4);
    const double start = swing.energy();
    for (int i = 0; i < 20000 / steps; ++i)
    {
        watch.add(swing.next(), 1e-4);
        if (watch.alarmed()) { return swing.energy() / start; }
    }
    return std::numeric_limits<double>::infinity();
}

TEST(EnergyWatch, SeesGrowthBeforeItIsTenfold)
{
    // Growth faster than the memory, and less than tenfold between two checks.
    for (const double growth : {1.003, 1.01, 1.1})
    {
        EXPECT_LT(growth_at_alarm(growth, 1), 10) << growth;
        EXPECT_LT(growth_at_alarm(growth, 8), 10) << growth;
    }
    EXPECT_LT(growth_at_alarm(3, 1), 10);
}

TEST(EnergyWatch, LetsLossesAndExchangesPass)
{
    EXPECT_TRUE(std::isinf(growth_at_alarm(1, 1)));
    EXPECT_TRUE(std::isinf(growth_at_alarm(0.99, 1)));
    EXPECT_TRUE(std::isinf(growth_at_alarm(1 + 0.1 / EnergyWatch::memory, 1)));
}

TEST(EnergyWatch, WorkOfGravityAndContactsIsASource)
{
    EnergyWatch watch(1.0, 10.0);
    SandReport  pushed;
    for (int i = 0; i < 5000; ++i)
    {
        // Each step 1 J of gravity and 2 J of contacts, of which 2.5 J heat the grains and the rest is stored.
        pushed.steps = 1;
        pushed.last_points[mpm::point_strain] += 0.5;
        pushed.points[mpm::point_plastic_work] = 2.5;
        pushed.points[mpm::point_contact_work] = 2;
        pushed.grid[mpm::grid_gravity_work]    = 1;
        watch.add(pushed, 1e-4);
        ASSERT_FALSE(watch.alarmed()) << i;
    }
    EXPECT_NEAR(watch.appeared(), 0, 1e-9 * watch.scale());
    pushed.points[mpm::point_plastic_work] = 20; // of 3 J
    for (int i = 0; i < 2000 && !watch.alarmed(); ++i) { watch.add(pushed, 1e-4); }
    EXPECT_TRUE(watch.alarmed());
}

PaceLimits limits()
{
    PaceLimits limits;
    limits.spacing    = 0.02;
    limits.wave_speed = 20;
    limits.courant    = 0.6;
    return limits;
}

TEST(SandGuard, RefusesStepsAtWhichNoSandIsStable)
{
    const SandGuard guard(limits(), 1);
    EXPECT_NO_THROW(guard.allow({0.99e-3, 1, ""}, 0));
    EXPECT_THROW(guard.allow({1.01e-3, 1, ""}, 0), NumericalError);
}

TEST(SandGuard, SaysWhatWhereAndWhichLimit)
{
    SandGuard  guard(limits(), 1);
    SandReport wild;
    wild.largest_speed = 50;
    try
    {
        guard.check(wild, {8e-4, 1, "fixed by the scene"}, 0.25);
        FAIL();
    }
    catch (const NumericalError& error)
    {
        const std::string text = error.what();
        for (const char* part :
             {"t = 0.25 s", "50 m/s", "dt = 0.0008 s (limit: fixed by the scene)", "0.8", "at most 0.6"})
        {
            EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
        }
    }
    SandReport lost;
    lost.peaks[mpm::peak_cell_change] = static_cast<double>(mpm::CellChange::not_finite);
    EXPECT_THROW(guard.check(lost, {1e-4, 1, ""}, 0), NumericalError);
}

} // namespace
