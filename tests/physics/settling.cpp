#include <cmath>
#include <string>

#include <fmt/format.h>

#include "harness.hpp"

// Beds that start from the geostatic stress and come to rest under local damping.
namespace
{

using namespace tread;

template<class Exec>
class Settling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Settling, test::Backends, test::BackendNames);

std::string bed_text(const std::string& terrain, double max_duration)
{
    return fmt::format(R"(
title = "settling"
[domain]
size    = [0.8, 0.05, 0.4]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.025
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
{}
[[phase]]
name = "settle"
damping = 0.3
until = "equilibrium"
max_duration = {}
)",
                       terrain, max_duration);
}

const std::string level = "region = { box = [[0.0, 0.0, 0.0], [0.8, 0.05, 0.2]] }";
const std::string heap  = "region = { box = [[0.0, 0.0, 0.0], [0.8, 0.05, 0.4]] }\n"
                          "height = \"0.25 - 0.36*abs(x - 0.4)\""; // 20 degrees

template<class Exec>
tread::run::PhaseEnd settle(const Exec& exec, const std::string& text)
{
    test::Experiment<Exec, float> experiment(exec, text);
    experiment.run();
    return experiment.phase_end();
}

/// Slowest mode of the bed: 4 H / c = 28 ms. Damping 0.3 leaves 0.54 per cycle (docs/verification.md#local-damping).
constexpr double cycle = 0.0276;

/// The initial stress is that of a level bed: only the error in one cell beside the floor is left to settle.
TYPED_TEST(Settling, LevelBedSettlesAtOnce)
{
    const tread::run::PhaseEnd end  = settle(this->exec(), bed_text(level, 2));
    const double               most = tread::run::equilibrium_hold + 2 * cycle;
    test::report("settled after, s", end.after, tread::run::equilibrium_hold, most - tread::run::equilibrium_hold,
                 "the time that equilibrium must hold, and two cycles");
    EXPECT_EQ(end.kind, tread::run::EndKind::settled);
    EXPECT_LT(end.after, most);
}

/// The initial stress of a heap of 20 degrees is only a first guess; it takes cycles to settle, and a run too short for
/// it reports that it has not settled.
TYPED_TEST(Settling, HeapSettlesSlowlyOrSaysThatItDidNot)
{
    const tread::run::PhaseEnd end   = settle(this->exec(), bed_text(heap, 2));
    const double               least = tread::run::equilibrium_hold + cycle;
    test::report("settled after, s", end.after, 0.5, 0.5, "some cycles of 28 ms, each leaving 0.54");
    EXPECT_EQ(end.kind, tread::run::EndKind::settled);
    EXPECT_GT(end.after, least);
    EXPECT_LE(end.unbalanced, tread::run::equilibrium_ratio);

    const tread::run::PhaseEnd cut = settle(this->exec(), bed_text(heap, 0.02));
    EXPECT_EQ(cut.kind, tread::run::EndKind::unsettled);
    EXPECT_NEAR(cut.after, 0.02, 1e-9);
    EXPECT_GT(cut.unbalanced, tread::run::equilibrium_ratio);
    EXPECT_NE(describe(cut).find("NOT settled"), std::string::npos);
}

} // namespace
