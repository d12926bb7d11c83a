#include "scene/slope.hpp"

#include <cmath>
#include <numbers>

namespace tread::scene
{
namespace
{

/// Cosine and sine of an angle in degrees, reduced to 45 degrees so that multiples of 90 are exact.
Vector2 unit_vector(double degrees)
{
    const double turn     = std::remainder(degrees, 360);
    const auto   quadrant = std::lround(turn / 90);
    const double rest     = (turn - 90 * static_cast<double>(quadrant)) * std::numbers::pi / 180;
    const double c = std::cos(rest), s = std::sin(rest);
    switch ((quadrant + 4) % 4)
    {
    case 0:
        return {c, s};
    case 1:
        return {-s, c};
    case 2:
        return {-c, -s};
    default:
        return {s, -c};
    }
}

} // namespace

Vector3 gravity_on(const Slope& slope)
{
    const double size             = slope.gravity.value_or(0);
    const auto [normal, uphill]   = unit_vector(slope.angle_deg);
    const auto [along_x, along_y] = unit_vector(slope.direction_deg);
    // Differences from 0 have no negative zeros.
    return {0 - size * uphill * along_x, 0 - size * uphill * along_y, 0 - size * normal};
}

} // namespace tread::scene
