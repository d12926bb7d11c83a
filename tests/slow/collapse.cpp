#include "../physics/collapse.hpp"
#include "../order.hpp"

namespace
{

using namespace tread;

template<class Exec>
class Collapse : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Collapse, test::Backends, test::BackendNames);

struct ExpectedRunOut
{
    double              aspect;
    std::array<int, 3>  cells; ///< across the column's width
    test::ExpectedOrder order;
    double              limit; ///< in widths, as measured; that of the laboratories is expected_run_out
};

template<class Exec>
void expect_run_out(const Exec& exec, const ExpectedRunOut& expected)
{
    std::array<double, 3> spacings{}, run_outs{}, fronts{}, last{};
    for (std::size_t i = 0; i < 3; ++i)
    {
        const test::Deposit left = test::collapse(exec, {expected.aspect, expected.cells[i]});
        spacings[i]              = 1.0 / expected.cells[i];
        run_outs[i]              = left.run_out;
        fronts[i]                = left.front;
        last[i]                  = left.last_point;
    }
    const std::string at   = fmt::format(" at aspect {}", expected.aspect);
    const auto        mass = test::expect_order("run-out of 99 % of the mass" + at, spacings, run_outs, expected.order);
    const auto        front = test::fit_power(spacings, fronts);
    test::report("limit of run-out" + at, mass.limit, expected.limit, 0.05 * expected.limit,
                 fmt::format("known error, to 5 %: the laboratories have {:.3g} +- 15 %",
                             test::expected_run_out(expected.aspect)));
    EXPECT_NEAR(mass.limit, expected.limit, 0.05 * expected.limit);
    fmt::print(
        "  front of 99.9 % of the mass{}: {:.4g}, {:.4g}, {:.4g}, order {:.3g}, limit {:.4g}; last point: {:.4g}, "
        "{:.4g}, {:.4g}\n",
        at, fronts[0], fronts[1], fronts[2], front.order, front.limit, last[0], last[1], last[2]);
}

/// docs/verification.md#column-collapse. The run-outs of the laboratories (expected_run_out, within 15 %) are met at
/// some 20 cells per width, but the run-out grows further with resolution: extrapolated to zero spacing it is 23, 25
/// and 15 % too long, a known error of the model.
TYPED_TEST(Collapse, RunOutAtThreeAspectRatios)
{
    const std::string why = "as found; other spacings give other orders (docs/accuracy.md)";
    expect_run_out(this->exec(), {0.6, {16, 32, 64}, {0.7, 1.3, why}, 0.884});
    expect_run_out(this->exec(), {1.1, {12, 24, 48}, {2.0, 2.8, why}, 1.644});
    expect_run_out(this->exec(), {3.0, {6, 12, 24}, {1.1, 1.8, why}, 4.554});
}

} // namespace
