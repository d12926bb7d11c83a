#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/errors.hpp"
#include "energy_balance.hpp"

// Pairs that touch in some phases and not in others (docs/phases.md#pairs-that-do-not-touch).
namespace touch_test
{

using namespace tread;

constexpr double g = 9.81, ball_mass = 0.1, rounding = 1e-12;

template<class Exec>
class Touch : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Touch, test::Backends, test::BackendNames);

/// A glass ball of 4 cm with its centre at `height` (m), below it whatever `more` adds.
std::string ball_text(double height, const std::string& walls, const std::string& more)
{
    return fmt::format(R"(
title = "ball and what it may pass"
[domain]
size    = [0.2, 0.2, 1.0]
gravity = [0.0, 0.0, -{}]
walls   = {{ {}, top = "open" }}
[numerics]
precision = "double"
[[material]]
name    = "glass"
model   = "elastic"
young   = 1.0e7
[[shape]]
name     = "ball"
generate = {{ kind = "sphere", nodes = 642 }}
[[body]]
name     = "ball"
shape    = "ball"
material = "glass"
mass     = {}
diameter = 0.04
position = [0.1, 0.1, {}]
{})",
                       g, walls, ball_mass, height, more);
}

const std::string open_sides = R"(x = "open", y = "open", bottom = "open")";
const std::string slip_sides = R"(x = "slip", y = "slip", bottom = "slip")";

/// A held plate between z = 0.48 and 0.5 m.
const std::string plate_text = R"(
[[material]]
name  = "steel"
model = "elastic"
young = 1.0e7
[[contact]]
between     = ["glass", "steel"]
restitution = 0.1
[[shape]]
name     = "plate"
generate = { kind = "box", size = [0.16, 0.16, 0.02] }
[[body]]
name     = "plate"
shape    = "plate"
material = "steel"
mass     = 1.0
position = [0.1, 0.1, 0.49]
)";

/// An elastic block on the floor, 0.2 m high.
const std::string block_text = R"(
[grid]
spacing = 0.05
[[material]]
name    = "sand"
model   = "elastic"
density = 1600.0
young   = 1.0e6
poisson = 0.0
[[terrain]]
material = "sand"
region   = { box = [[0.0, 0.0, 0.0], [0.2, 0.2, 0.2]] }
)";

/// A phase that holds `held` and sets whether the ball and `other` touch.
std::string phase(const std::string& name, double duration, const std::string& other, const std::string& touch,
                  const std::string& held = "")
{
    return fmt::format("[[phase]]\nname = \"{}\"\nduration = {}\nhold = [{}]\n"
                       "contacts = [ {{ between = [\"glass\", \"{}\"], touch = {} }} ]\n",
                       name, duration, held, other, touch);
}

const std::string plate_held = "\"plate\"";

template<class Run>
double ball_speed(Run& run)
{
    return run.simulation().named_bodies()[0].velocity[2];
}

template<class Exec>
void expect_closed(test::Experiment<Exec>& run, double energy)
{
    test::report("energy unaccounted", energy, 0, test::closes, "that of all scenes");
    EXPECT_LT(energy, test::closes);
    run.simulation().ledger().balance(run.simulation().census());
    const double momentum = run.simulation().ledger().errors().momentum;
    test::report("momentum unaccounted over weight and time", momentum, 0, 1e-10, "rounding in fp64");
    EXPECT_LT(momentum, 1e-10);
}

/// The pair touches again when the ball is below the plate.
TYPED_TEST(Touch, ABallFallsThroughAPlateThatItDoesNotTouch)
{
    test::Experiment<TypeParam> run(this->exec(), ball_text(0.55, open_sides, plate_text) +
                                                      phase("open", 0.15, "steel", "false", plate_held) +
                                                      phase("closed", 0.05, "steel", "true", plate_held));
    const double                energy = test::largest_unaccounted(run);
    const double                speed  = ball_speed(run);
    test::report("velocity at the end, m/s", speed, -g * 0.2, rounding, "free fall; symplectic Euler has it exactly");
    EXPECT_NEAR(speed, -g * 0.2, rounding);
    expect_closed(run, energy);
}

/// Energies before and after the step in which a pair ceases to touch, and the largest change of their total, J.
struct Release
{
    solver::EnergyRow before, after;
    double            off = 0;
};

template<class Exec>
Release watch_release(test::Experiment<Exec>& run, double end_of_touch)
{
    Release release;
    double  start = 0;
    run.run(
        [&](double time)
        {
            const solver::EnergyRow row = run.simulation().ledger().energy(run.simulation().census());
            if (start == 0) { start = row.total; }
            release.off = std::max(release.off, std::abs(row.total - start));
            if (time <= end_of_touch + 1e-9) { release.before = row; }
            else if (release.after.total == 0) { release.after = row; }
        });
    return release;
}

/// `tolerance`: of the friction of that step over what the contacts had stored, and why it is what it is.
template<class Exec>
void expect_booked(test::Experiment<Exec>& run, const Release& release, double tolerance, const char* why)
{
    const double stored = release.before.contact, gained = release.after.friction - release.before.friction;
    const double fall = 0.5 * ball_mass * std::pow(ball_speed(run), 2);
    ASSERT_GT(stored, 0);
    test::report("friction by the release over what the contacts had stored", gained / stored, 1, tolerance, why);
    EXPECT_NEAR(gained / stored, 1, tolerance);
    EXPECT_EQ(release.after.contact, 0);
    test::report("energy unaccounted over that of the fall", release.off / fall, 0, test::closes, "that of all scenes");
    EXPECT_LT(release.off, test::closes * fall);
    std::cout << "[ physics  ] the contacts had stored " << stored / fall << " of the energy of the fall\n";
}

TYPED_TEST(Touch, ABallRestsOnAPlateUntilTheyCeaseToTouch)
{
    test::Experiment<TypeParam> run(this->exec(), ball_text(0.52, open_sides, plate_text) +
                                                      phase("closed", 0.2, "steel", "true", plate_held) +
                                                      phase("open", 0.1, "steel", "false", plate_held));
    const Release               release = watch_release(run, 0.2);
    const double                speed   = ball_speed(run);
    test::report("velocity 0.1 s after the release, m/s", speed, -g * 0.1, 1e-3 * g * 0.1,
                 "free fall from rest; the contact has come to rest within 0.1 %");
    EXPECT_NEAR(speed, -g * 0.1, 1e-3 * g * 0.1);
    expect_booked(run, release, 1e-9, "all of it becomes friction; rounding");
}

TYPED_TEST(Touch, ABallFallsFreelyThroughSandAndFloorThatItDoesNotTouch)
{
    const std::string           walls = "[[contact]]\nbetween = [\"glass\", \"wall\"]\ntouch = false\n";
    const std::string           sand  = "[[contact]]\nbetween = [\"glass\", \"sand\"]\ntouch = false\n";
    const std::string           fixed = "[time]\ndt = 2e-4\n";
    test::Experiment<TypeParam> run(this->exec(), ball_text(0.24, slip_sides, block_text + walls + sand + fixed) +
                                                      "[[phase]]\nname = \"fall\"\nduration = 0.25\n");
    test::Experiment<TypeParam> alone(this->exec(), ball_text(0.9, slip_sides, block_text + fixed) +
                                                        "[[phase]]\nname = \"fall\"\nduration = 0.25\n");
    const double                energy = test::largest_unaccounted(run);
    const double                speed  = ball_speed(run);
    test::report("velocity at the end, m/s", speed, -g * 0.25, rounding, "free fall; symplectic Euler has it exactly");
    EXPECT_NEAR(speed, -g * 0.25, rounding);
    alone.run();
    const double momentum  = run.simulation().census().sand.momentum[2],
                 untouched = alone.simulation().census().sand.momentum[2], scale = 12.8 * g * 0.25;
    test::report("momentum of the sand, N s", momentum, untouched, rounding * scale,
                 "that of the same sand with the ball far above it, to rounding of its weight times time");
    EXPECT_NEAR(momentum, untouched, rounding * scale);
    expect_closed(run, energy);
}

TYPED_TEST(Touch, ABallRestsOnSandUntilTheyCeaseToTouch)
{
    std::string text = ball_text(0.24, slip_sides, block_text);
    text.replace(text.find("0.1, 0.24]"), 10, "0.1, \"on surface\"]");
    test::Experiment<TypeParam> run(this->exec(),
                                    text + phase("closed", 0.1, "sand", "true") + phase("open", 0.05, "sand", "false"));
    const Release               release = watch_release(run, 0.1);
    const double coupling = release.after.coupling - release.before.coupling, stored = release.before.contact;
    test::report("coupling error by the release over what the contacts had stored", coupling / stored, 0, 1e-9,
                 "no contact is left that could have one; rounding");
    EXPECT_NEAR(coupling / stored, 0, 1e-9);
    expect_booked(run, release, 1e-2, "all of it becomes friction; the floor takes some from the sand in that step");
}

/// A pair that touches from a phase on in which the two are still apart.
TYPED_TEST(Touch, APairThatBeginsInTimeLandsLikeOneThatAlwaysTouched)
{
    const std::string           fixed = "[time]\ndt = 1e-4\nsubsteps = 4\n";
    test::Experiment<TypeParam> late(this->exec(), ball_text(0.53, open_sides, plate_text + fixed) +
                                                       phase("open", 0.02, "steel", "false", plate_held) +
                                                       phase("closed", 0.1, "steel", "true", plate_held));
    test::Experiment<TypeParam> always(this->exec(), ball_text(0.53, open_sides, plate_text + fixed) +
                                                         phase("first", 0.02, "steel", "true", plate_held) +
                                                         phase("then", 0.1, "steel", "true", plate_held));
    late.run();
    always.run();
    const double found    = late.simulation().named_bodies()[0].position[2],
                 expected = always.simulation().named_bodies()[0].position[2];
    test::report("height of the ball, m", found, expected, rounding, "the same contact from the same first touch");
    EXPECT_NEAR(found, expected, rounding);
    EXPECT_GT(found, 0.5) << "it fell through";
}

template<class Exec>
std::string refusal(const Exec& exec, const std::string& text)
{
    test::Experiment<Exec> run(exec, text);
    try
    {
        run.run();
    }
    catch (const NumericalError& error)
    {
        return error.what();
    }
    return "";
}

/// The ball has fallen into the plate, the floor or the sand.
TYPED_TEST(Touch, APairThatOverlapsMustNotBegin)
{
    using ::testing::HasSubstr;
    const std::string plate = refusal(this->exec(), ball_text(0.525, open_sides, plate_text) +
                                                        phase("open", 0.05, "steel", "false", plate_held) +
                                                        phase("closed", 0.1, "steel", "true", plate_held));
    EXPECT_THAT(plate, HasSubstr("t = 0.05 s: body 'ball' and body 'plate' begin to touch in phase 'closed', and "
                                 "overlap by 0.007"));
    EXPECT_THAT(plate, HasSubstr("accepted: at most 2e-08 m"));
    const std::string wall =
        refusal(this->exec(), ball_text(0.04, slip_sides, "") + phase("open", 0.1, "wall", "false") +
                                  phase("closed", 0.1, "wall", "true"));
    EXPECT_THAT(wall, HasSubstr("t = 0.1 s: body 'ball' and a wall begin to touch in phase 'closed', and overlap by "));
    const std::string sand =
        refusal(this->exec(), ball_text(0.24, slip_sides, block_text) + phase("open", 0.1, "sand", "false") +
                                  phase("closed", 0.1, "sand", "true"));
    EXPECT_THAT(sand, HasSubstr("t = 0.1 s: body 'ball' and sand begin to touch in phase 'closed', and "));
    EXPECT_THAT(sand, HasSubstr(" points of sand overlap it, by up to "));
}

} // namespace touch_test
