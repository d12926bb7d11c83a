#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness.hpp"

// Conserved quantities and losses of the transfers between points and grid.
namespace transfers_test
{

using namespace tread;

template<class Exec>
class Transfers : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Transfers, test::Backends, test::BackendNames);

/// A free elastic box without weight; `numerics` and `time` are lines of those tables.
std::string free_box(const std::string& size, const std::string& box, const std::string& material,
                     const std::string& numerics, double dt, double duration)
{
    return fmt::format(R"(
title = "free box"
[domain]
size    = {}
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "open", y = "slip", bottom = "slip", top = "slip" }}
[grid]
spacing = 0.05
[time]
dt = {}
[numerics]
precision = "double"
{}
[[material]]
name = "elastic"
model = "elastic"
density = 1000.0
{}
[[terrain]]
material = "elastic"
region = {{ box = {} }}
[[phase]]
name = "go"
duration = {}
)",
                       size, dt, numerics, material, box, duration);
}

/// Sets every point's velocity to velocity(position), and its stress to zero.
template<class Exec, class Velocity>
void set_off(test::Experiment<Exec>& run, Velocity velocity)
{
    auto&             points = run.simulation().sand().points();
    const auto        x      = points.position.to_host();
    auto              v      = points.velocity.to_host();
    const std::size_t n      = x.size() / 3;
    for (std::size_t i = 0; i < n; ++i)
    {
        const Vec3<double> at = velocity(Vec3<double>(x[i], x[n + i], x[2 * n + i]));
        for (std::size_t c = 0; c < 3; ++c) { v[c * n + i] = at[static_cast<Eigen::Index>(c)]; }
    }
    points.velocity.assign(v);
    points.stress.fill_zero();
}

/// docs/verification.md#bar with free ends, which need no wall: a bar of 20 cells in its first mode, T = 2 L / c = 0.02
/// s, ten periods at a Courant number of 0.1.
TYPED_TEST(Transfers, FreeBarKeepsPeriodAndEnergy)
{
    struct Case
    {
        const char* transfer;
        double      least; ///< smallest share of the energy after ten periods
        const char* why;
    };
    for (const Case& c :
         {Case{"transfer = \"flip\"\npic_rate = 0.0", 0.98, "docs/verification.md#bar: amplitude decay below 1 %"},
          Case{"transfer = \"aflip\"\npic_rate = 0.0", 0.98, "docs/verification.md#bar, as FLIP"}})
    {
        const double                dt = 0x1p-14;
        test::Experiment<TypeParam> bar(this->exec(),
                                        free_box("[1.5, 0.05, 0.05]", "[[0.25, 0.0, 0.0], [1.25, 0.05, 0.05]]",
                                                 "young = 1.0e7\npoisson = 0.0", c.transfer, dt, 0.2));
        set_off(bar, [](const Vec3<double>& x)
                { return Vec3<double>(0.1 * std::cos(std::numbers::pi * (x[0] - 0.25)), 0, 0); });
        const double start = bar.simulation().census().sand.kinetic;
        double       last = 0, crossing = 0;
        int          crossings = 0;
        auto&        points    = bar.simulation().sand().points();
        bar.run(
            [&](double time)
            {
                const auto  x = points.position.to_host(), v = points.velocity.to_host(); // of the mode itself
                double      amplitude = 0;
                std::size_t n         = x.size() / 3;
                for (std::size_t i = 0; i < n; ++i) { amplitude += v[i] * std::cos(std::numbers::pi * (x[i] - 0.25)); }
                if (last * amplitude < 0)
                {
                    ++crossings;
                    crossing = time - bar.dt() * amplitude / (amplitude - last);
                }
                last = amplitude;
            });
        const double         period = 2 * crossing / (crossings - 0.5);
        const solver::Census end    = bar.simulation().census();
        const double         energy = (end.sand.kinetic + end.sand.strain) / start;
        const std::string    name   = std::string(c.transfer).substr(11, 6);
        test::report("period in s, " + name, period, 0.02, 2e-4, "docs/verification.md#bar: 1 % at 20 cells");
        test::report("energy after ten periods, " + name, energy, 1, 1 - c.least, c.why);
        EXPECT_NEAR(period, 0.02, 2e-4);
        EXPECT_GT(energy, c.least);
        EXPECT_LT(energy, 1.01);
    }
}

/// Angular momentum about the vertical: of the points' velocities, plus their spin if they are affine.
template<class Exec>
double spin(test::Experiment<Exec>& run, double spacing)
{
    auto&             points = run.simulation().sand().points();
    const auto        x = points.position.to_host(), m = points.mass.to_host();
    const auto        v = points.velocity.to_host(), affine = points.affine.to_host();
    const std::size_t n     = x.size() / 3;
    double            total = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        total += m[i] * (x[i] * v[n + i] - x[n + i] * v[i]);
        // C[y][x] - C[x][y] times the second moment h^2/4 of the quadratic spline (Jiang et al. 2015).
        if (!affine.empty()) { total += m[i] * spacing * spacing / 4 * (affine[3 * n + i] - affine[n + i]); }
    }
    return total;
}

/// docs/verification.md#rotation-and-translation: an elastic block spins freely at 10 rad/s. APIC conserves its angular
/// momentum indefinitely, FLIP only over the grid's step; the loss in between is printed.
TYPED_TEST(Transfers, SpinningBlockKeepsItsAngularMomentum)
{
    struct Case
    {
        const char* transfer;
        double      tolerance;
        const char* why;
    };
    for (const Case& c :
         {Case{"apic\"", 1e-11, "rounding of 1280 steps (docs/verification.md#rotation-and-translation: 1e-12 a step)"},
          Case{"flip\"\npic_rate = 0.0", HUGE_VAL,
               "the figure alone: docs/verification.md#rotation-and-translation sets no bound"},
          Case{"aflip\"", 0.01, "1 % a turn: a rover's wheel turns once in 10 s, its sand does not"}})
    {
        const double      dt = 0x1p-11;
        const std::string text =
            free_box("[2.0, 2.0, 0.05]", "[[0.8, 0.8, 0.0], [1.2, 1.2, 0.05]]", "young = 1.0e6\npoisson = 0.3",
                     std::string("transfer = \"") + c.transfer, dt, 0.625);
        test::Experiment<TypeParam> block(this->exec(), text);
        set_off(block, [](const Vec3<double>& x) { return Vec3<double>(-10 * (x[1] - 1), 10 * (x[0] - 1), 0); });
        const solver::Census start = block.simulation().census();
        std::vector<double>  spins = {spin(block, 0.05)};
        block.run([&](double) { spins.push_back(spin(block, 0.05)); });
        const solver::Census end    = block.simulation().census();
        const double         energy = (end.sand.kinetic + end.sand.strain) / start.sand.kinetic;
        const std::string    name   = std::string(c.transfer).substr(0, std::string(c.transfer).find('"'));
        // Affine points have no spin of their own before the first step.
        const double turn = spins.back() / spins[1] - 1, first = spins[1] / spins[0] - 1;
        test::report(fmt::format("change of angular momentum in a turn, {} (energy {:.4f})", name, energy), turn, 0,
                     c.tolerance, c.why);
        if (std::isfinite(c.tolerance)) { EXPECT_NEAR(turn, 0, c.tolerance); }
        EXPECT_LT(energy, 1.001);
        if (name == "aflip") { continue; }
        test::report("change of angular momentum in the first step, " + name, first, 0, 1e-12,
                     "docs/verification.md#rotation-and-translation");
        EXPECT_NEAR(first, 0, 1e-12);
    }
}

/// docs/verification.md#rotation-and-translation: 10 m/s through ten cells, without strain.
TYPED_TEST(Transfers, TranslationMakesNoStress)
{
    for (const char* transfer : {"flip", "apic", "aflip"})
    {
        for (const char* shape : {"quadratic", "linear"})
        {
            const auto numerics = fmt::format("transfer = \"{}\"\nshape_functions = \"{}\"", transfer, shape);
            test::Experiment<TypeParam> box(this->exec(),
                                            free_box("[1.2, 0.2, 0.2]", "[[0.2, 0.0, 0.0], [0.4, 0.2, 0.2]]",
                                                     "young = 1.0e6\npoisson = 0.3", numerics, 0x1p-11, 0.05));
            set_off(box, [](const Vec3<double>&) { return Vec3<double>(10, 0, 0); });
            box.run();
            double worst = 0;
            for (const double s : box.simulation().sand().points().stress.to_host())
            {
                worst = std::max(worst, std::abs(s));
            }
            // The strain error per step is v dt/h times the rounding of the slopes, 1e-14; 102 steps add up. Between
            // linear hat functions the lightest node has a millionth of a point's mass, which amplifies the rounding
            // accordingly.
            const bool   linear    = shape == std::string("linear");
            const double tolerance = 1e6 * 102 * (10 * 0x1p-11 / 0.05) * 1e-14 * (linear ? 1e6 : 1);
            test::report(fmt::format("stress in Pa, {}, {}", transfer, shape), worst, 0, tolerance,
                         linear ? "the same through nodes of 1e-6 of a mass" : "rounding of the slopes, 1e-14 a step");
            EXPECT_LT(worst, tolerance);
        }
    }
}

} // namespace transfers_test
