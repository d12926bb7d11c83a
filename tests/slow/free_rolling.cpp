#include <cmath>

#include <fmt/format.h>

#include "../physics/harness.hpp"

// A freely rolling drum travels as far as its rim turns, whatever the size of the points under it.
namespace
{

using namespace tread;

template<class Exec>
class FreeRolling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FreeRolling, test::Backends, test::BackendNames);

constexpr double radius = 0.1, rate = 5.0; ///< m, 1/s

/// A drum on an elastic layer in plane strain, two cells thick, which it indents by a few thousandths of its height.
std::string text(double spacing)
{
    return fmt::format(R"(
title = "drum that rolls freely"
[domain]
size    = [0.4, {0}, 0.3]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = {1}
[[material]]
name    = "layer"
model   = "elastic"
density = 1000.0
young   = 1.0e6
poisson = 0.3
[[material]]
name   = "steel"
model  = "rigid"
young  = 1.0e9
[[contact]]
between  = ["steel", "layer"]
friction = 0.8
[[shape]]
name     = "drum"
generate = {{ kind = "wheel", radius = {2}, width = {3}, wall_thickness = 0.05, grousers = 0 }}
[[terrain]]
material = "layer"
region   = {{ box = [[0.0, 0.0, 0.0], [0.4, {0}, 0.04]] }}
[[body]]
name     = "drum"
shape    = "drum"
material = "steel"
mass     = {4}
position = [0.13, {1}, {5}]
lock     = ["y", "roll", "yaw"]
[[phase]]
name     = "settle"
duration = 0.05
damping  = 0.3
drive    = {{ body = "drum", angular_velocity = 0.0 }}
[[phase]]
name     = "roll"
duration = 0.4
drive    = {{ body = "drum", angular_velocity = {6}, ramp = 0.15 }}
)",
                       2 * spacing, spacing, radius, 1.96 * spacing, 3.0 * 2 * spacing,
                       0.04 + radius + 0.5 * spacing * 0.12, rate);
}

TYPED_TEST(FreeRolling, DrumRollsOnItsOwnRadius)
{
    for (const int cells : {5, 10, 20})
    {
        test::Experiment<TypeParam> run(this->exec(), text(radius / cells));
        double                      from = 0, place = 0;
        run.run(
            [&](double time)
            {
                if (from > 0 || time < 0.25) { return; }
                from  = time;
                place = run.simulation().named_bodies()[0].position[0];
            });
        const double way   = run.simulation().named_bodies()[0].position[0] - place;
        const double ratio = way / (rate * radius * (run.time() - from));
        // With contact at the points' centres it would roll on R + 0.3 h: 1.06, 1.03 and 1.015.
        test::report(fmt::format("v / (omega R), R / h = {}", cells), ratio, 1, 5e-3,
                     "issue: 0.5 %; the layer's own strain is some thousandths");
        EXPECT_NEAR(ratio, 1, 5e-3);
    }
}

} // namespace
