#include <cmath>

#include <fmt/format.h>

#include "energy_balance.hpp"

// A column of sand whose stiffness grows with the root of pressure (docs/theory.md#stiffness-with-pressure).
namespace stiffening_test
{

using namespace tread;

template<class Exec>
class StiffeningColumn : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(StiffeningColumn, test::Backends, test::BackendNames);

constexpr double g = 9.81, density = 1800, height = 0.1, young = 1e6, poisson = 0.25, stiff_pressure = 1e4;

/// One cell wide between slip walls; gravity doubles.
std::string column_text(double spacing)
{
    return fmt::format(R"(
title = "column under gravity that doubles"
[domain]
size    = [{0}, {0}, {1}]
gravity = [0.0, 0.0, -{2}]
walls   = {{ x = "slip", y = "slip", bottom = "slip", top = "open" }}
[grid]
spacing = {0}
[numerics]
precision = "double"
[[material]]
name               = "sand"
model              = "mohr-coulomb"
friction_angle_deg = 40.0
density            = {3}
young              = {4}
poisson            = {5}
young_pressure     = {6}
[[terrain]]
material = "sand"
region   = {{ box = [[0.0, 0.0, 0.0], [{0}, {0}, {7}]] }}
[[phase]]
name     = "double"
gravity  = [0.0, 0.0, -{8}]
damping  = 0.7
duration = 0.2
)",
                       spacing, height + 4 * spacing, g, density, young, poisson, stiff_pressure, height, 2 * g);
}

/// Sinking of a point at the height z when gravity doubles, of the strain sqrt(stress p_s/(M sqrt(K M))) with the bulk
/// and the uniaxial modulus of half of `young`.
double sinking(double z)
{
    const double half = young / 2, bulk = half / (3 * (1 - 2 * poisson)),
                 uniaxial = half * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
    const double size     = std::sqrt(density * g * stiff_pressure / (uniaxial * std::sqrt(bulk * uniaxial)));
    return (std::sqrt(2.0) - 1) * size * 2 / 3 * (std::pow(height, 1.5) - std::pow(height - z, 1.5));
}

TYPED_TEST(StiffeningColumn, SinksAsTheRootOfItsWeight)
{
    for (const double spacing : {0.01, 0.005})
    {
        test::Experiment<TypeParam> column(this->exec(), column_text(spacing));
        const double                unaccounted = test::largest_unaccounted(column);
        auto&                       points      = column.simulation().sand().points();
        const auto                  start = points.start.to_host(), end = points.position.to_host();
        const auto                  stride = static_cast<std::size_t>(points.stride);
        const auto                  count  = static_cast<std::size_t>(column.simulation().sand().count());
        double                      worst  = 0;
        for (std::size_t i = 2 * stride; i < 2 * stride + count; ++i)
        {
            worst = std::max(worst, std::abs(start[i] - end[i] - sinking(start[i])) / sinking(height));
        }
        const std::string at = fmt::format(" ({} cells)", std::lround(height / spacing));
        test::report("sinking over that of the surface, largest error" + at, worst, 0, spacing / height,
                     "a quarter cell's weight beside the floor and half a cell's under the surface, where it is soft");
        test::report("energy unaccounted" + at, unaccounted, 0, test::closes, "as for one modulus");
        EXPECT_LT(worst, spacing / height);
        EXPECT_LT(unaccounted, test::closes);
    }
}

} // namespace stiffening_test
