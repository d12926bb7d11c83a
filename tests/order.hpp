#pragma once

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "physics/harness.hpp"

// Orders of convergence from three spacings or time steps.
namespace tread::test
{

/// Fit of f0 + c h^p through three values.
struct PowerFit
{
    double limit;  ///< f0
    double order;  ///< p; NaN if the values do not approach a limit
    double factor; ///< c
};

/// Fits a power. `steps` decrease. The ratio of the differences grows with p: bisection between p = 0.05 and 8.
inline PowerFit fit_power(const std::array<double, 3>& steps, const std::array<double, 3>& values)
{
    const auto ratio = [&](double p)
    { return (std::pow(steps[0], p) - std::pow(steps[1], p)) / (std::pow(steps[1], p) - std::pow(steps[2], p)); };
    const double wanted = (values[0] - values[1]) / (values[1] - values[2]);
    double       low = 0.05, high = 8;
    if (!(wanted > ratio(low) && wanted < ratio(high))) { return {std::nan(""), std::nan(""), std::nan("")}; }
    for (int i = 0; i < 60; ++i)
    {
        const double middle                   = 0.5 * (low + high);
        (ratio(middle) < wanted ? low : high) = middle;
    }
    const double factor = (values[1] - values[2]) / (std::pow(steps[1], low) - std::pow(steps[2], low));
    return {values[2] - factor * std::pow(steps[2], low), low, factor};
}

/// Expected interval of an order of convergence, and the reason for it.
struct ExpectedOrder
{
    double      low, high;
    std::string why;
};

/// Fits, prints and checks the order. Returns the fit; the caller checks its limit.
inline PowerFit expect_order(const std::string& what, const std::array<double, 3>& steps,
                             const std::array<double, 3>& values, const ExpectedOrder& expected)
{
    const PowerFit fit = fit_power(steps, values);
    report(fmt::format("order of {} ({:.4g}, {:.4g}, {:.4g}; limit {:.4g})", what, values[0], values[1], values[2],
                       fit.limit),
           fit.order, 0.5 * (expected.low + expected.high), 0.5 * (expected.high - expected.low), expected.why);
    EXPECT_GE(fit.order, expected.low) << what;
    EXPECT_LE(fit.order, expected.high) << what;
    return fit;
}

} // namespace tread::test
