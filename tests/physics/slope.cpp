#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "harness.hpp"

// A long layer of sand on a rough slope; its ends do not influence its middle (docs/verification.md#layer-on-a-slope).
namespace slope_test
{

using namespace tread;

template<class Exec>
class FullSizeSlope : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeSlope, test::Backends, test::BackendNames);

constexpr double gravity = 9.8, thickness = 0.1, length = 2.4;

/// Sand of 30 degrees, held for `damped` s under damping and then free for `duration` s; x points down a slope of
/// `degrees`.
std::string slope_text(double degrees, const std::string& numerics, double damped, double duration)
{
    const double angle = degrees * std::numbers::pi / 180;
    return fmt::format(R"(
title = "layer on a slope"
[domain]
size    = [3.6, 0.02, 0.2]
gravity = [{}, 0.0, {}]
walls   = {{ x = "open", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = 0.02
[numerics]
precision = "double"
{}
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region = {{ box = [[0.1, 0.0, 0.0], [{}, 0.02, {}]] }}
[[phase]]
name = "settle"
damping = 0.7
duration = {}
[[phase]]
name = "watch"
duration = {}
)",
                       gravity * std::sin(angle), -gravity * std::cos(angle), numerics, 0.1 + length, thickness, damped,
                       duration);
}

/// Points that start in the middle sixth: mean displacement down the slope, m, and speed, m/s.
struct Middle
{
    double way = 0, speed = 0;
};

template<class Experiment>
Middle middle(Experiment& slope)
{
    const auto& points = slope.simulation().sand().points();
    const auto  start = points.start.to_host(), now = points.position.to_host(), v = points.velocity.to_host();
    const auto  count = static_cast<std::size_t>(slope.simulation().sand().count());
    Middle      mean;
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        if (std::abs(start[i] - 0.1 - 0.5 * length) > length / 12) { continue; }
        mean.way += now[i] - start[i];
        mean.speed += v[i];
        ++found;
    }
    mean.way /= static_cast<double>(found);
    mean.speed /= static_cast<double>(found);
    return mean;
}

/// Below the angle of friction it does not move.
TYPED_TEST(FullSizeSlope, LayerStaysBelowItsAngle)
{
    test::Experiment<TypeParam> slope(this->exec(), slope_text(22, "", 0.2, 0.2));
    Middle                      before{};
    const auto                  look = [&](double time)
    {
        if (before.way == 0 && time >= 0.3) { before = middle(slope); }
    };
    slope.run(look);
    const double creep = (middle(slope).way - before.way) / 0.1 / thickness, most = 1e-3;
    test::report("creep in thicknesses a second at 22 degrees", creep, 0, most,
                 "docs/verification.md#layer-on-a-slope");
    EXPECT_LT(std::abs(creep), most);
}

/// Above it, friction is between that of the critical state of a layer of constant volume (Davis 1968: tan = sin for
/// dilation 0) and that of the Mohr-Coulomb envelope. A transfer that filters resolved shear slows a layer of five
/// cells: FLIP with its default filter gives 0.17 m/s2.
TYPED_TEST(FullSizeSlope, LayerAcceleratesAboveItsAngle)
{
    test::Experiment<TypeParam> slope(this->exec(), slope_text(35, "", 0.001, 0.35));
    Middle                      early{};
    double                      since = 0;
    const auto                  look  = [&](double time)
    {
        if (since == 0 && time >= 0.15)
        {
            early = middle(slope);
            since = time;
        }
    };
    slope.run(look);
    const double angle = 35 * std::numbers::pi / 180, phi = std::numbers::pi / 6;
    const double least    = gravity * (std::sin(angle) - std::cos(angle) * std::tan(phi));
    const double most     = gravity * (std::sin(angle) - std::cos(angle) * std::sin(phi));
    const double measured = (middle(slope).speed - early.speed) / (slope.time() - since);
    test::report("acceleration at 35 degrees in m/s2", measured, 0.5 * (least + most), 0.5 * (most - least),
                 "docs/verification.md#layer-on-a-slope: between Davis and tan phi");
    EXPECT_GT(measured, least);
    EXPECT_LT(measured, most);
}

} // namespace slope_test
