#include <algorithm>
#include <limits>
#include <string>

#include "base/errors.hpp"
#include "physics/rock_scenes.hpp"

// Rocks at the limits of what a scene may specify: stable at the automatic step, or stopped with a diagnosis; none
// passes through a wall, and none gains energy.
namespace rocks_test
{

using namespace tread;

struct Case
{
    std::string  name;
    Vec3<double> size     = {0.5, 0.5, 1.0};
    double       young    = 1e8;
    double       friction = 0.5;
    std::string  rocks    = "";
    std::string  body     = "";
    double       duration = 0.25;
    bool         may_stop = false; ///< the law cannot carry it, and must report so
};

std::string rained(int count, double diameter, const std::string& low, const std::string& high)
{
    return fmt::format(R"(
[[rocks]]
shape = "clast"
material = "stone"
count = {}
diameter = {}
placement = "rain"
region = {{ box = [{}, {}] }}
)",
                       count, diameter, low, high);
}

/// A clast released at z (m), or thrown down.
std::string thrown(double diameter, const std::string& mass, double z, double speed)
{
    return fmt::format(R"(
[[body]]
name = "big"
shape = "clast"
material = "stone"
diameter = {}
{}
position = [0.25, 0.25, {}]
velocity = [0.0, 0.0, {}]
)",
                       diameter, mass, z, -speed);
}

std::string text_of(const Case& c)
{
    return test::rock_domain(c.size, 0, "x = \"fixed\", y = \"fixed\", bottom = \"fixed\", top = \"open\"", "") +
           test::stone(c.young, c.friction, 0.5) + R"(
[[shape]]
name = "clast"
generate = { kind = "rock", seed = 3, nodes = 60 }
sdf_cells = 24
)" + c.rocks +
           c.body + test::phase("run", 0, c.duration);
}

struct Outcome
{
    double      rise    = 0; ///< J, rise of the mechanical energy above its minimum so far
    double      kinetic = 0; ///< J, largest
    double      lowest  = 1; ///< m, of all centres above the floor
    double      outside = 0; ///< m, of any centre beyond a side wall
    std::string stopped;     ///< the diagnosis
};

template<class Exec>
Outcome run_case(const Exec& exec, const Case& c)
{
    Outcome                found;
    double                 least = std::numeric_limits<double>::infinity();
    test::Experiment<Exec> run(exec, text_of(c));
    int                    steps = 0;
    const auto             look  = [&](double)
    {
        if (steps++ % 10 != 0) { return; }
        const solver::RigidCensus now    = run.simulation().census().rigid;
        const double              energy = now.kinetic + now.contact + now.gravity;
        least                            = std::min(least, energy);
        found.rise                       = std::max(found.rise, energy - least);
        found.kinetic                    = std::max(found.kinetic, now.kinetic);
        const io::BodyFields fields      = run.simulation().body_fields();
        for (std::size_t i = 0; i < fields.position.size(); i += 3)
        {
            found.lowest = std::min(found.lowest, fields.position[i + 2]);
            for (std::size_t a = 0; a < 2; ++a)
            {
                const double x = fields.position[i + a];
                found.outside  = std::max({found.outside, -x, x - c.size[static_cast<Eigen::Index>(a)]});
            }
        }
    };
    try
    {
        run.run(look);
    }
    catch (const NumericalError& error)
    {
        found.stopped = error.what();
    }
    return found;
}

template<class Exec>
void expect_sane(const Exec& exec, const Case& c)
{
    SCOPED_TRACE(c.name);
    const Outcome found = run_case(exec, c);
    if (!found.stopped.empty())
    {
        std::cout << "[ physics  ] " << c.name << ": stopped: " << found.stopped << "\n";
        EXPECT_TRUE(c.may_stop) << found.stopped;
        EXPECT_NE(found.stopped.find("overlaps"), std::string::npos);
        return;
    }
    test::report(c.name + ": rise of the mechanical energy over the largest kinetic one", found.rise / found.kinetic, 0,
                 0.04, "an entry or exit overshoots by a substep of 0.2 sqrt(m/K): 0.2^2 of the impact's energy");
    EXPECT_LT(found.rise, 0.04 * found.kinetic);
    EXPECT_GT(found.lowest, 0) << "through the floor";
    EXPECT_EQ(found.outside, 0) << "through a wall";
}

template<class Exec>
class RockStability : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(RockStability, test::Backends, test::BackendNames);

const std::string few = rained(10, 0.1, "[0, 0, 0]", "[0.5, 0.5, 0.4]");

TYPED_TEST(RockStability, AnyStiffness)
{
    for (const double young : {1e6, 1e8, 5e10})
    {
        Case c{fmt::format("E = {:g} Pa", young)};
        c.young = young;
        c.rocks = few;
        expect_sane(this->exec(), c);
    }
}

TYPED_TEST(RockStability, AnyFriction)
{
    for (const double friction : {0.0, 1e6})
    {
        Case c{fmt::format("friction {:g}", friction)};
        c.friction = friction;
        c.rocks    = few;
        expect_sane(this->exec(), c);
    }
}

/// 1.4 g against 1.4 t.
TYPED_TEST(RockStability, AMillionfoldMass)
{
    for (const double young : {1e7, 5e10})
    {
        Case c{fmt::format("1.4 t on rocks of 1.4 g, E = {:g} Pa", young)};
        c.young    = young;
        c.rocks    = rained(20, 0.01, "[0.2, 0.2, 0]", "[0.3, 0.3, 0.012]");
        c.body     = thrown(0.1, "mass = 1400.0", 0.075, 0);
        c.duration = 0.08;
        c.may_stop = true;
        expect_sane(this->exec(), c);
    }
}

TYPED_TEST(RockStability, AHundredMetresASecond)
{
    for (const double young : {1e7, 5e10})
    {
        Case c{fmt::format("100 m/s on a bed, E = {:g} Pa", young)};
        c.young    = young;
        c.rocks    = rained(20, 0.1, "[0, 0, 0]", "[0.5, 0.5, 0.6]");
        c.body     = thrown(0.1, "density = 2700.0", 0.9, 100);
        c.duration = 0.02;
        c.may_stop = young < 1e9;
        expect_sane(this->exec(), c);
    }
}

/// A thousand grains within one cell of the pair search, whose size is set by a boulder just below the limit for large
/// bodies.
TYPED_TEST(RockStability, AThousandInACell)
{
    Case c{"1,000 rocks of 10 mm under one of 39 mm"};
    c.size     = {0.5, 0.5, 0.5};
    c.young    = 1e7;
    c.rocks    = rained(1000, 0.01, "[0.19, 0.19, 0]", "[0.31, 0.31, 0.2]");
    c.body     = thrown(0.039, "density = 2700.0", 0.25, 1);
    c.duration = 0.03;
    expect_sane(this->exec(), c);
}

} // namespace rocks_test
