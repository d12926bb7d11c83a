#include <cmath>

#include "base/errors.hpp"
#include "harness.hpp"

namespace
{

using namespace tread;

template<class Exec>
class Coupling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Coupling, test::Backends, test::BackendNames);

using test::roller_text;

/// docs/verification.md#body-at-rest-on-sand, #momentum-balance: at rest the contact carries the weight; impulses
/// balance to rounding in fp64.
TYPED_TEST(Coupling, SandCarriesTheWeightOfARoller)
{
    std::string text = roller_text;
    text.replace(text.find("duration = 0.05"), 15, "duration = 0.6\ndamping = 0.5");
    test::Experiment<TypeParam> rest(this->exec(), text);
    bool                        started = false;
    rest.run(
        [&](double time)
        {
            if (time > 0.4 && !started)
            {
                rest.simulation().begin_mean();
                started = true;
            }
        });
    const double force = rest.simulation().named_bodies().at(0).force[2], weight = 4.0 * 9.81;
    test::report("mean contact force in N", force, weight, 0.01 * weight,
                 "1 % of the weight, time mean (docs/verification.md#body-at-rest-on-sand)");
    EXPECT_NEAR(force, weight, 0.01 * weight);
    const double error = rest.simulation().ledger().balance(rest.simulation().census()).impulse_error;
    test::report("impulse error over weight x time", error, 0, 1e-10,
                 "fp64 rounding (docs/verification.md#momentum-balance)");
    EXPECT_LT(error, 1e-10);
}

/// The number of substeps does not change the force on a body on sand (D3): with all else fixed, N = 1 and 20 agree.
TYPED_TEST(Coupling, SubstepsDoNotChangeTheImpact)
{
    const auto depth = [&](const std::string& substeps)
    {
        test::Experiment<TypeParam> drop(this->exec(),
                                         roller_text + "[time]\ndt = 2.0e-4\nsubsteps = " + substeps + "\n");
        double                      lowest = 1;
        drop.run([&](double) { lowest = std::min(lowest, drop.simulation().named_bodies().at(0).position[2]); });
        return 0.33 - lowest;
    };
    const double one = depth("1"), twenty = depth("20");
    test::report("fall after 0.05 s, N = 20 over N = 1", twenty / one, 1, 0.01,
                 "docs/verification.md#points-during-the-substeps: N changes depth by at most 0.6 % at fixed dt");
    EXPECT_NEAR(twenty / one, 1, 0.01);
}

/// A fixed number of substeps that is too small is refused when contact begins, not computed.
TYPED_TEST(Coupling, TooFewFixedSubstepsAreStopped)
{
    std::string text = test::sand_text + test::rocks_text + "[time]\ndt = 1.0e-3\nsubsteps = 1\n";
    text.replace(text.find("1.0e7"), 5, "1.0e9");
    test::Experiment<TypeParam> stiff(this->exec(), text);
    try
    {
        stiff.run();
        FAIL() << "one substep of 1 ms cannot carry rocks of 1e9 Pa";
    }
    catch (const NumericalError& error)
    {
        EXPECT_NE(std::string(error.what()).find("substep"), std::string::npos) << error.what();
    }
}

} // namespace
