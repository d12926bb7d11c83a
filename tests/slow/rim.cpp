#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "../physics/harness.hpp"

// Sand inside and outside a rim interacts through the grid if the wall is too thin for the grid to resolve.
namespace rim_test
{

using namespace tread;

template<class Exec>
class Rim : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Rim, test::Backends, test::BackendNames);

constexpr double radius = 0.15, wall = 0.02, speed = 0.5, settling = 0.1, duration = 0.02;

/// A frictionless drum that lies in sand, with sand in its lower half.
std::string drum_text(double spacing)
{
    const double clear = 0.65 * spacing; // a point's radius with some clearance
    return fmt::format(R"scene(
title = "sand within and around a rim"
[domain]
size    = [0.4, 0.4, 0.4]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "slip", top = "open" }}
[grid]
spacing = {spacing}
[numerics]
precision = "double"
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 1.0e6
poisson = 0.3
friction_angle_deg = 30.0
[[material]]
name = "steel"
model = "rigid"
young = 1.0e9
poisson = 0.3
[[contact]]
between = ["steel", "sand"]
friction = 0.0
[[terrain]]
material = "sand"
region = {{ box = [[0.02, 0.0, 0.0], [0.38, 0.4, 0.2]] }}
height = "0.2 - sqrt(max({around}^2 - (x - 0.2)^2, 0))"
[[terrain]]
material = "sand"
region = {{ box = [[0.07, 0.0, 0.0], [0.33, 0.4, 0.2]] }}
floor = "0.2 - sqrt(max({within}^2 - (x - 0.2)^2, 0))"
[[shape]]
name = "drum"
generate = {{ kind = "wheel", radius = {radius}, width = 0.396, wall_thickness = {wall}, grousers = 0, grouser_height = 0.0 }}
sdf_cells = 128
[[body]]
name = "drum"
shape = "drum"
material = "steel"
mass = 10.0
position = [0.2, 0.2, 0.2]
lock = ["x", "y", "roll", "pitch", "yaw"]
[[phase]]
name = "settle"
damping = 0.7
duration = {settling}
[[phase]]
name = "shear"
duration = {duration}
)scene",
                       fmt::arg("spacing", spacing), fmt::arg("radius", radius), fmt::arg("wall", wall),
                       fmt::arg("settling", settling), fmt::arg("duration", duration),
                       fmt::arg("around", radius + clear), fmt::arg("within", radius - wall - clear));
}

/// Moves the sand around the drum along its axle. Returns the share of that speed that the sand inside, which nothing
/// should move, has reached in its middle third.
template<class Exec>
double leaked(const Exec& exec, double spacing)
{
    test::Experiment<Exec> run(exec, drum_text(spacing));
    auto&                  points = run.simulation().sand().points();
    const auto             n      = static_cast<std::size_t>(points.count);
    const auto             within = [&](const std::vector<double>& start, std::size_t i)
    { return std::hypot(start[i] - 0.2, start[2 * n + i] - 0.2) < radius - 0.5 * wall; };
    bool       slides = false;
    const auto push   = [&](double time)
    {
        if (slides || time < settling) { return; }
        const auto          start    = points.start.to_host();
        std::vector<double> velocity = points.velocity.to_host();
        for (std::size_t i = 0; i < n; ++i) { velocity[n + i] += within(start, i) ? 0.0 : speed; }
        points.velocity.assign(velocity);
        slides = true;
    };
    run.run(push);
    const auto start = points.start.to_host(), now = points.velocity.to_host();
    double     sum   = 0;
    int        count = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        if (!within(start, i) || std::abs(start[n + i] - 0.2) > 0.06) { continue; }
        sum += now[n + i];
        ++count;
    }
    return sum / count / speed;
}

/// A node reached by points on both sides transmits stress: with quadratic weights over three cells.
TYPED_TEST(Rim, KeepsWhatIsAroundFromWhatIsWithin)
{
    const double wide = leaked(this->exec(), 2 * wall), coarse = leaked(this->exec(), wall),
                 fine = leaked(this->exec(), 0.5 * wall);
    std::cout << fmt::format("[ physics  ] the same with cells of 2 walls {:.3g}, of one {:.3g}\n", wide, coarse);
    test::report("speed that sand within the rim got in 20 ms, over that around it, cells of half a wall", fine, 0,
                 1e-3, "2.6 cells between points on both sides: the last 0.4 of a cell of the weights' reach");
    EXPECT_LT(std::abs(fine), 1e-3);
    EXPECT_GT(coarse, 10 * std::abs(fine)); // otherwise there would be nothing to keep out
}

} // namespace rim_test
