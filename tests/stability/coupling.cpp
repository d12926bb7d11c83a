#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "physics/harness.hpp"

// Bodies and sand at the limits of what a scene may specify: stable at the automatic step, or stopped with a diagnosis.
namespace
{

using namespace tread;

/// A roller of 20 cm thrown at 20 cm of sand in a box of 0.4 m with cells of 0.05 m: points of 25 g.
struct Case
{
    std::string  name;
    std::string  size     = "[0.4, 0.4, 0.6]";
    double       gravity  = 9.81;
    std::string  walls    = R"(x = "slip", y = "slip", bottom = "fixed", top = "open")";
    std::string  numerics = "";
    double       sand     = 1e6; ///< Pa
    double       wheel    = 1e9; ///< Pa
    double       mass     = 4;
    Vec3<double> position = {0.2, 0.2, 0.305};
    Vec3<double> velocity = {0, 0, -1};
    std::string  shape =
        R"(kind = "wheel", radius = 0.1, width = 0.15, wall_thickness = 0.04, grousers = 12, grouser_height = 0.01)";
    std::string diameter = ""; ///< line of the body
    double      duration = 0.03;
    std::string may_stop = ""; ///< text that a diagnosis must then contain
};

std::string row(const Vec3<double>& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string text_of(const Case& c)
{
    return fmt::format(R"(
title = "{}"
[domain]
size    = {}
gravity = [0.0, 0.0, -{}]
walls   = {{ {} }}
[grid]
spacing = 0.05
[numerics]
{}
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = {:e}
poisson = 0.3
friction_angle_deg = 30.0
[[material]]
name = "steel"
model = "elastic"
density = 7800.0
young = {:e}
poisson = 0.3
[[terrain]]
material = "sand"
region = {{ box = [[0.0, 0.0, 0.0], [0.4, 0.4, 0.2]] }}
[[shape]]
name = "thrown"
generate = {{ {} }}
sdf_cells = 48
[[body]]
name = "thrown"
shape = "thrown"
{}
material = "steel"
mass = {:e}
position = {}
velocity = {}
[[phase]]
name = "run"
duration = {}
)",
                       c.name, c.size, c.gravity, c.walls, c.numerics, c.sand, c.wheel, c.shape, c.diameter, c.mass,
                       row(c.position), row(c.velocity), c.duration);
}

struct Outcome
{
    double       held = 0; ///< kinetic and elastic energy over the energy supplied so far by motion, stress and fall
    Vec3<double> position = Vec3<double>::Zero(), velocity = Vec3<double>::Zero();
    int          steps = 0;
    std::string  stopped; ///< the diagnosis
};

template<class Exec>
Outcome outcome(const Exec& exec, const Case& c)
{
    Outcome                out;
    test::Experiment<Exec> run(exec, text_of(c));
    const solver::Census   start = run.simulation().census();
    // A body gets its velocity when the first phase releases it.
    const double begin = start.sand.kinetic + start.sand.strain + 0.5 * c.mass * c.velocity.squaredNorm();
    double       given = begin;
    const auto   look  = [&](double)
    {
        if (++out.steps % 5 != 0) { return; }
        const solver::Census now = run.simulation().census();
        const double         fell =
            c.gravity * (start.sand.moment - now.sand.moment)[2] + start.rigid.gravity - now.rigid.gravity;
        given = std::max(given, begin + fell);
        const double holds =
            now.sand.kinetic + now.sand.strain + now.rigid.kinetic + now.rigid.contact + now.sand_contact;
        out.held     = std::isfinite(holds) ? std::max(out.held, holds / given) : 1e300;
        out.position = run.simulation().named_bodies().at(0).position;
        out.velocity = run.simulation().named_bodies().at(0).velocity;
    };
    try
    {
        run.run(look);
    }
    catch (const NumericalError& error)
    {
        out.stopped = error.what();
    }
    std::cout << fmt::format("[ stability] {}: {} after {} steps, energy {:.3g}, at {} with {} m/s\n", c.name,
                             out.stopped.empty() ? "ran" : "stopped", out.steps, out.held, row(out.position),
                             row(out.velocity));
    if (!out.stopped.empty()) { std::cout << "    " << out.stopped << '\n'; }
    return out;
}

/// Tolerance 10 %: an impact overshoots by 0.2^2 of its energy (a substep of 0.2 sqrt(m/K)), and velocities of a census
/// are half a step older than positions.
void expect_sane(const Case& c, const Outcome& out)
{
    EXPECT_LT(out.held, 1.1);
    if (out.stopped.empty()) { return; }
    EXPECT_FALSE(c.may_stop.empty()) << out.stopped;
    EXPECT_NE(out.stopped.find(c.may_stop), std::string::npos);
    EXPECT_NE(out.stopped.find("t = "), std::string::npos);
}

template<class Exec>
class CouplingStability : public test::BackendTest<Exec>
{
protected:
    Outcome run(const Case& c)
    {
        SCOPED_TRACE(c.name);
        const Outcome out = outcome(this->exec(), c);
        expect_sane(c, out);
        return out;
    }
};
TYPED_TEST_SUITE(CouplingStability, test::Backends, test::BackendNames);

TYPED_TEST(CouplingStability, AnyStiffness)
{
    for (const double sand : {1e4, 1e6, 1e8})
    {
        for (const double wheel : {1e0, 1e3, 1e6, 1e9})
        {
            Case c{fmt::format("wheel of {:g} Pa on sand of {:g} Pa", wheel, sand)};
            c.sand  = sand;
            c.wheel = wheel;
            this->run(c);
        }
    }
}

/// Mass ratio against a point of 25 g.
TYPED_TEST(CouplingStability, AMillionfoldMass)
{
    for (const double mass : {2.5e4, 2.5e-8})
    {
        Case c{fmt::format("wheel of {:g} kg", mass)};
        c.mass = mass;
        if (mass < 1) { c.may_stop = "moves"; } // the weight of a point on it throws it off within a substep
        this->run(c);
    }
}

TYPED_TEST(CouplingStability, AHundredMetresASecond)
{
    for (const double sand : {1e6, 1e8})
    {
        Case c{fmt::format("100 m/s at sand of {:g} Pa", sand)};
        c.sand     = sand;
        c.velocity = {0, 0, -100};
        c.duration = 2e-3;
        if (sand < 1e8) { c.may_stop = "so deep in body"; } // three times as fast as its pressure
        this->run(c);
    }
}

TYPED_TEST(CouplingStability, ARockAsSmallAsAPoint)
{
    for (const char* refined : {"", "refine_below = 2.0"})
    {
        Case c{fmt::format("rock of 31 mm{}", *refined == 0 ? "" : ", nine samples a point")};
        c.numerics = refined;
        c.shape    = R"(kind = "rock", seed = 3, nodes = 60)";
        c.diameter = "diameter = 0.031";
        c.mass     = 0.041;
        c.position = {0.2, 0.2, 0.23};
        c.duration = 0.1;
        this->run(c);
    }
}

TYPED_TEST(CouplingStability, AWheelThatLeaves)
{
    Case c{"wheel thrown out of the domain"};
    c.walls    = R"(x = "open", y = "slip", bottom = "fixed", top = "open")";
    c.velocity = {10, 0, 2};
    c.duration = 0.1;
    this->run(c);
}

TYPED_TEST(CouplingStability, NoWeight)
{
    Case c{"no weight"};
    c.gravity  = 0;
    c.duration = 0.1;
    this->run(c);
}

} // namespace
