#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "harness.hpp"
#include "solver/bodies/dem_solver.hpp"

// Guards that stop a faulty run of bodies, and contacts that a correct run must not miss.
namespace
{

using namespace tread;

template<class Exec>
class Guards : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Guards, test::Backends, test::BackendNames);

std::string ball(const char* name, double diameter, double mass, const std::string& position,
                 const std::string& velocity)
{
    return fmt::format(R"([[body]]
name     = "{}"
shape    = "ball"
material = "steel"
diameter = {}
mass     = {}
position = {}
velocity = {}
)",
                       name, diameter, mass, position, velocity);
}

std::string text(double duration, double dt, int substeps, const std::string& bodies)
{
    return test::steel_text + fmt::format(R"(
[time]
dt       = {}
substeps = {}
{}
[[phase]]
name     = "go"
duration = {}
)",
                                          dt, substeps, bodies, duration);
}

/// A heavy ball hits a light one at rest, which leaves at twice its speed and hits a third within the same long step.
/// The third is 5 % of a radius away, more than a search allows for two bodies at rest. One step of 96 substeps must
/// give the result of 96 steps of one substep, each with a new pair search.
TYPED_TEST(Guards, BodyThatIsHitWithinAStepMissesNoContact)
{
    const std::string balls = ball("heavy", 0.1, 1000, "[1.0, 0.5, 0.5]", "[2.0, 0.0, 0.0]") +
                              ball("light", 0.1, 1, "[1.1001, 0.5, 0.5]", "[0.0, 0.0, 0.0]") +
                              ball("third", 0.1, 1, "[1.2026, 0.5, 0.5]", "[0.0, 0.0, 0.0]");
    constexpr double dt   = 1.6e-3;
    const auto       ends = [&](double step, int substeps)
    {
        test::Experiment<TypeParam> experiment(this->exec(), text(dt, step, substeps, balls));
        experiment.run();
        return experiment.simulation().named_bodies();
    };
    const auto long_step = ends(dt, 96), short_steps = ends(dt / 96, 1);
    test::report("velocity of the third ball, m/s", long_step[2].velocity[0], short_steps[2].velocity[0], 0,
                 "the same substeps; a contact that is missed leaves it at rest");
    EXPECT_GT(short_steps[2].velocity[0], 0.5);
    for (std::size_t b = 0; b < 3; ++b)
    {
        EXPECT_NEAR(long_step[b].velocity[0], short_steps[b].velocity[0], 1e-9);
        EXPECT_NEAR(long_step[b].position[0], short_steps[b].position[0], 1e-12);
    }
}

template<class Call>
std::string stop(const Call& call)
{
    try
    {
        call();
    }
    catch (const NumericalError& error)
    {
        EXPECT_EQ(error.code(), ExitCode::numerical);
        return error.what();
    }
    return "went on";
}

TYPED_TEST(Guards, BodyThatLeapsOverAnotherStopsTheRunByName)
{
    const std::string balls = ball("sleeper", 0.1, 1, "[3.0, 0.5, 0.5]", "[0.0, 0.0, 0.0]") +
                              ball("bullet", 0.1, 1, "[1.0, 0.5, 0.5]", "[600.0, 0.0, 0.0]");
    const std::string found = stop(
        [&]
        {
            test::Experiment<TypeParam> experiment(this->exec(), text(0.01, 1e-3, 10, balls));
            experiment.run();
        });
    EXPECT_NE(found.find("'bullet'"), std::string::npos) << found;
    EXPECT_NE(found.find("t = "), std::string::npos) << found;
    EXPECT_NE(found.find("in a substep"), std::string::npos) << found;
}

/// NaN anywhere in a body's state stops the step in which it appears.
TYPED_TEST(Guards, NotANumberIsNamedAtOnce)
{
    const TypeParam   exec  = this->exec();
    const std::string balls = ball("first", 0.1, 1, "[1.0, 0.5, 0.5]", "[0.0, 0.0, 0.0]") +
                              ball("second", 0.1, 1, "[2.0, 0.5, 0.5]", "[0.0, 0.0, 0.0]");
    const scene::Scene scene = test::load_text(text(0.01, 1e-3, 1, balls));
    const world::World world = world::build_world(scene);
    const Vec3<double> lost(0, std::numeric_limits<double>::quiet_NaN(), 0);
    for (auto array : {&dem::BodiesView::velocity, &dem::BodiesView::angular_velocity, &dem::BodiesView::position})
    {
        solver::DemSolver<TypeParam> rigid(exec, scene, world, solver::make_plan(scene, world));
        rigid.command(std::vector<solver::BodyCommand>(2));
        rigid.find_pairs(1e-3);
        copy_from_host(exec, rigid.view().*array + 1, &lost, sizeof(lost));
        rigid.stage();
        rigid.contact(1e-3);
        rigid.move(1e-3, 0);
        const std::string found = stop([&] { rigid.report(0.25); });
        EXPECT_NE(found.find("'second'"), std::string::npos) << found;
        EXPECT_NE(found.find("t = 0.25"), std::string::npos) << found;
        EXPECT_NE(found.find("not a number"), std::string::npos) << found;
    }
}

/// The last guard: an unchecked body that has moved farther than its pair search allowed.
TYPED_TEST(Guards, BodyBeyondItsSearchStopsTheRunByName)
{
    const TypeParam   exec  = this->exec();
    const std::string balls = ball("first", 0.1, 1, "[1.0, 0.5, 0.5]", "[0.0, 0.0, 0.0]") +
                              ball("second", 0.1, 1, "[2.0, 0.5, 0.5]", "[0.0, 0.0, 0.0]");
    const scene::Scene           scene = test::load_text(text(0.01, 1e-3, 1, balls));
    const world::World           world = world::build_world(scene);
    solver::DemSolver<TypeParam> rigid(exec, scene, world, solver::make_plan(scene, world));
    rigid.command(std::vector<solver::BodyCommand>(2));
    rigid.find_pairs(1e-3);
    rigid.begin_substeps({1e-3, 10, ""}, 0, 0); // nothing moves: nobody watches
    const Vec3<double> thrown(0, 5, 0);         // 5 mm in the step; 1 % of 50 mm are allowed
    copy_from_host(exec, rigid.view().velocity + 1, &thrown, sizeof(thrown));
    rigid.stage();
    rigid.contact(1e-3);
    rigid.move(1e-3, 0);
    const std::string found = stop([&] { rigid.report(0.25); });
    EXPECT_NE(found.find("'second'"), std::string::npos) << found;
    EXPECT_NE(found.find("search"), std::string::npos) << found;
}

} // namespace
