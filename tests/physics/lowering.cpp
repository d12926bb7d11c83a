#include <cmath>

#include "energy_balance.hpp"

// A body lowered onto the ground until the ground carries it, and one with part of its weight supported.
namespace
{

using namespace tread;

template<class Exec>
class Lowering : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Lowering, test::Backends, test::BackendNames);

/// A roller of 40 kg that stands on the sand of roller_text, and phases.
std::string standing_roller(const std::string& phases)
{
    std::string text = test::roller_text;
    text.replace(text.find("position = [0.2, 0.2, 0.33]"), 27,
                 "position = [0.2, 0.2, \"on surface\"]\ngap = 0.001\nvelocity = [0.0, 0.0, -1.0]");
    text.replace(text.find("mass     = 4.0"), 14, "mass     = 40.0");
    const auto first = text.find("[[phase]]"), end = text.find("[output]");
    return text.replace(first, end - first, phases);
}

std::string lower(double speed, double share)
{
    return "[[phase]]\nname = \"lower\"\nuntil = \"lowered\"\nmax_duration = 2.0\nlower = { body = \"roller\", speed "
           "= " +
           std::to_string(speed) + ", share = " + std::to_string(share) + " }\n";
}

const std::string rest = "[[phase]]\nname = \"rest\"\nduration = 0.1\n";

/// Descent of the roller since the start, m.
template<class Exec>
double sunk(test::Experiment<Exec>& run)
{
    return run.world().bodies.position[0][2] - run.simulation().named_bodies()[0].position[2];
}

TYPED_TEST(Lowering, EndsWhenTheSandCarriesTheShareAndTheBalanceCloses)
{
    for (const double share : {0.5, 1.0})
    {
        test::Experiment<TypeParam> run(this->exec(), standing_roller(lower(0.05, share)));
        run.run();
        solver::Ledger& ledger = run.simulation().ledger();
        ledger.energy(run.simulation().census());
        ledger.balance(run.simulation().census());
        const double                unaccounted = std::abs(ledger.errors().energy);
        const tread::run::PhaseEnd& end         = run.phase_end();
        EXPECT_EQ(end.kind, tread::run::EndKind::lowered);
        const double lag = 0.05;
        test::report("share of the weight that the sand carries", end.carried, share, lag * share,
                     "the load grows by less between two looks");
        EXPECT_GE(end.carried, share);
        EXPECT_LE(end.carried, (1 + lag) * share);
        test::report("unaccounted energy", unaccounted, 0, test::closes, "design, section 7");
        EXPECT_LT(unaccounted, test::closes);
        const io::ErrorReport errors = ledger.errors();
        test::report("unaccounted momentum over weight and time", errors.momentum, 0, 1e-10, "rounding in fp64");
        EXPECT_LT(errors.momentum, 1e-10);
    }
}

TYPED_TEST(Lowering, LetsTheBodyGoAtRest)
{
    // The scene gives it 1 m/s downwards when it is first released; that does not apply to a body that stands.
    test::Experiment<TypeParam> run(this->exec(), standing_roller(lower(0.02, 1.0) + rest));
    double                      lowered = 0, fastest = 0;
    bool                        released = false;
    run.run(
        [&](double)
        {
            const solver::BodyRow roller = run.simulation().named_bodies()[0];
            released                     = released || std::abs(roller.velocity[2] + 0.02) > 1e-12;
            if (released) { fastest = std::max(fastest, roller.velocity.norm()); }
            else { lowered = sunk(run); }
        });
    const double further = sunk(run) - lowered;
    // The part of the resistance to lowering that came from the inertia of the sand, rho c v times the area, is gone
    // then: 1600 kg/m3 x 29 m/s x 0.02 m/s x 0.15 m x 0.1 m are 14 of 392 N.
    test::report("fastest after the release, m/s", fastest, 0, 0.02, "the speed of lowering: it bobs a little");
    EXPECT_LT(fastest, 0.02);
    test::report("sinks further by, of its depth", further / lowered, 14.0 / 392, 0.05, "that and bobbing");
    EXPECT_LT(std::abs(further), 0.05 * lowered);
}

TYPED_TEST(Lowering, SinkageDoesNotHangOnTheSpeedAndADropGoesDeeper)
{
    const auto depth = [&](const std::string& phases)
    {
        test::Experiment<TypeParam> run(this->exec(), standing_roller(phases));
        run.run();
        return sunk(run);
    };
    const double fast = depth(lower(0.1, 1.0) + rest), slow = depth(lower(0.05, 1.0) + rest), dropped = depth(rest);
    test::report("sinkage at 0.1 over that at 0.05 m/s", fast / slow, 1, 0.05,
                 "inertia of the sand goes with v squared");
    EXPECT_NEAR(fast / slow, 1, 0.05);
    test::report("sinkage when thrown at 1 m/s over that", dropped / slow, 1.2, 0,
                 "at least: the sand takes its momentum, too");
    EXPECT_GT(dropped / slow, 1.2);
}

/// A ball that falls by 0.1 m to the floor of the domain; `share` of its weight acts. Errors of the contact, some
/// percent of a fall by a few overlaps, are not tested here: energies are compared during the fall, forces at rest.
std::string ball_text(double share)
{
    std::string text = test::steel_text;
    text.replace(text.find("gravity = [0.0, 0.0, 0.0]"), 25, "gravity = [0.0, 0.0, -9.81]");
    text.replace(text.find("bottom = \"open\""), 15, "bottom = \"slip\"");
    text.replace(text.find("restitution = 1.0"), 17, "restitution = 0.1");
    return text + R"(
[[body]]
name     = "ball"
shape    = "ball"
material = "steel"
diameter = 0.2
density  = 7800.0
position = [2.0, 0.5, 0.2]
[[phase]]
name     = "rest"
duration = 1.0
weight   = { body = "ball", from = )" +
           std::to_string(share) + ", to = " + std::to_string(share) + " }\n";
}

TYPED_TEST(Lowering, TheFloorCarriesTheShareOfTheWeightThatActs)
{
    for (const double share : {0.5, 1.0, 2.0})
    {
        test::Experiment<TypeParam> run(this->exec(), ball_text(share));
        double                      worst = 0;
        bool                        last  = false;
        run.run(
            [&](double time)
            {
                solver::Ledger& ledger = run.simulation().ledger();
                ledger.energy(run.simulation().census());
                ledger.balance(run.simulation().census());
                if (time < 0.09) { worst = std::max(worst, std::abs(ledger.errors().energy)); }
                if (time > 0.8 && !std::exchange(last, true)) { run.simulation().begin_mean(); }
            });
        const double weight = 9.81 * run.world().bodies.mass[0];
        const double force  = run.simulation().named_bodies()[0].force[2];
        test::report("force of the floor over the weight", force / weight, share, 0.01 * share,
                     "it hardly bobs any more");
        EXPECT_NEAR(force / weight, share, 0.01 * share);
        test::report("unaccounted energy of the fall", worst, 0, 1e-10,
                     "rounding in fp64: the work of what holds it is exact");
        EXPECT_LT(worst, 1e-10);
        const double momentum = run.simulation().ledger().errors().momentum;
        test::report("unaccounted momentum over weight and time", momentum, 0, 1e-10, "rounding in fp64");
        EXPECT_LT(momentum, 1e-10);
    }
}

} // namespace
