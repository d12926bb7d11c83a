#include <cmath>

#include <fmt/format.h>

#include "lone_point.hpp"

// Conservation of momentum and trajectories of points, to rounding.
namespace
{

using namespace tread;

template<class Exec>
class Conservation : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Conservation, test::Backends, test::BackendNames);

/// Three materials with different wave speeds fall on each other: their points share nodes.
TYPED_TEST(Conservation, MomentumOfSeveralMaterials)
{
    for (const char* transfer : {"flip", "apic", "aflip"})
    {
        const std::string           text = R"(
title = "three materials"
[domain]
size    = [0.4, 0.4, 0.8]
gravity = [0.5, 0.0, -9.81]
walls   = { x = "slip", y = "slip", bottom = "fixed", top = "open" }
[grid]
spacing = 0.05
[[material]]
name = "soft"
model = "mohr-coulomb"
density = 1500.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[material]]
name = "stiff"
model = "mohr-coulomb"
density = 1700.0
young = 9.0e6
poisson = 0.2
friction_angle_deg = 38.0
cohesion = 100.0
[[material]]
name = "block"
model = "elastic"
density = 2500.0
young = 4.0e6
poisson = 0.25
[[terrain]]
material = "stiff"
region = { box = [[0.0, 0.0, 0.0], [0.4, 0.4, 0.1]] }
[[terrain]]
material = "soft"
region = { box = [[0.0, 0.0, 0.1], [0.4, 0.4, 0.2]] }
[[terrain]]
material = "block"
region = { box = [[0.1, 0.1, 0.25], [0.3, 0.3, 0.4]] }
[[phase]]
name = "fall"
duration = 0.15
[numerics]
precision = "double"
)";
        test::Experiment<TypeParam> run(this->exec(), text + "transfer = \"" + transfer + "\"\n");
        run.run();
        const double error = run.simulation().ledger().balance(run.simulation().census()).impulse_error;
        test::report(fmt::format("impulse error over weight x time, {}", transfer), error, 0, 1e-10,
                     "fp64 rounding (verification docs/verification.md#momentum-balance)");
        EXPECT_LT(error, 1e-10);
    }
}

/// docs/verification.md#free-flight: x + v t, z + w t - g t (t + dt) / 2, the parabola of symplectic Euler.
TYPED_TEST(Conservation, LonePointFliesAParabola)
{
    for (const char* transfer : {"flip", "apic", "aflip"})
    {
        const std::string           numerics = fmt::format("precision = \"double\"\ntransfer = \"{}\"", transfer);
        test::Experiment<TypeParam> run(this->exec(), test::lone_point(900, -9.81, numerics, "0.0009765625", 0.5));
        test::throw_it(run, {0.7, 0.2, 3});
        const Vec3<double> start = run.simulation().sand().positions()[0];
        run.run();
        const double       t = run.time();
        const Vec3<double> there =
            start + t * Vec3<double>(0.7, 0.2, 3) - Vec3<double>(0, 0, 0.5 * 9.81 * t * (t + 0.0009765625));
        const double off = (run.simulation().sand().positions()[0] - there).norm();
        // 512 steps, each rounded at x = 900 m: 1e-13 m.
        test::report(fmt::format("off the parabola in m, {}", transfer), off, 0, 1e-10, "rounding at 900 m, 512 steps");
        EXPECT_LT(off, 1e-10);
    }
}

TYPED_TEST(Conservation, CreepFarFromTheOriginIsKept)
{
    test::creep<double>(this->exec(), "double", 20000);
    test::creep<float>(this->exec(), "single", 20000);
}

} // namespace
