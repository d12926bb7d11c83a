#include "../physics/collapse.hpp"

namespace
{

using namespace tread;

template<class Exec>
class Collapse : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Collapse, test::Backends, test::BackendNames);

double slope(const test::CollapseSetup& low, double below, const test::CollapseSetup& high, double above)
{
    return std::log(above / below) / std::log(high.aspect / low.aspect);
}

/// verification C5: three aspect ratios; run-out grows with the aspect ratio, and with its power 2/3 for high columns.
TYPED_TEST(Collapse, RunOutAtThreeAspectRatios)
{
    const test::CollapseSetup setups[3] = {{0.6, 24}, {1.1, 20}, {3.0, 16}};
    double                    run_out[3];
    for (int i = 0; i < 3; ++i)
    {
        const test::Deposit left = test::collapse(this->exec(), setups[i]);
        test::check_deposit(setups[i], left);
        run_out[i] = left.run_out;
    }
    // Two run-outs that are each 15 % off: ln(1.15 / 0.85) over ln of the ratio of aspects.
    for (int i = 0; i < 2; ++i)
    {
        const double measured  = slope(setups[i], run_out[i], setups[i + 1], run_out[i + 1]);
        const double expected  = slope(setups[i], test::expected_run_out(setups[i].aspect), setups[i + 1],
                                       test::expected_run_out(setups[i + 1].aspect));
        const double tolerance = std::log(1.15 / 0.85) / std::log(setups[i + 1].aspect / setups[i].aspect);
        test::report(fmt::format("power of run-out between aspects {} and {}", setups[i].aspect, setups[i + 1].aspect),
                     measured, expected, tolerance, "from 15 % of each");
        EXPECT_NEAR(measured, expected, tolerance);
    }
}

} // namespace
