#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.hpp"

// Lengths and angles derived from a wheel's parameters. Metres and radians; y along the axle, 0 in the middle.
namespace tread::shape
{

/// Largest angle between neighbouring columns or rows of a wheel's mesh: 2 degrees, whose chords stay within 0.015 % of
/// the radius.
constexpr double longest_wheel_chord = 3.14159265358979323846 / 90;

/// InputError, naming `origin` and the key with its accepted range, unless the parameters are compatible.
void check_wheel(const scene::WheelGenerator& wheel, const std::string& origin);

/// Radius of the drum, without grousers, at y.
double drum_radius(const scene::WheelGenerator& wheel, double y);

/// Radius of the drum's inner surface at y.
double inner_radius(const scene::WheelGenerator& wheel, double y);

/// Radius over the grousers at y.
double tip_radius(const scene::WheelGenerator& wheel, double y);

/// Inner radius of the flanges; without flanges, of the drum at its edges.
double rim_radius(const scene::WheelGenerator& wheel);

/// Angle of the grousers' centre lines at y, relative to y = 0; 0 without grousers.
double sweep(const scene::WheelGenerator& wheel, double y);

/// Half the angle of a grouser, as wide as at its foot, at a radius.
double half_angle(const scene::WheelGenerator& wheel, double radius);

/// Columns of a wheel's mesh, which follow the grousers, and rows across the axle.
struct WheelGrid
{
    scene::WheelGenerator wheel;
    std::vector<double>
           rows;  ///< ascending y, m: symmetric about 0, which is one of them, as are faces of flanges and web
    double chord; ///< m, length of `longest_wheel_chord` on the drum
    double pitch; ///< angle between grousers; the full turn without grousers
    int    pitches;
    int    gap_columns;  ///< from one grouser's foot to the next grouser
    int    foot_columns; ///< across a grouser; 0 without grousers
    int    levels;       ///< from a grouser's foot to its tip
};

/// Grid of a wheel that passed `check_wheel`. No step turns or curves more than a chord does.
WheelGrid wheel_grid(const scene::WheelGenerator& wheel);

/// Number of steps, each at most `longest` up to rounding, that make up `way`; at least one.
int steps_over(double way, double longest);

} // namespace tread::shape
