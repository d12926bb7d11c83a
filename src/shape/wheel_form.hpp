#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.hpp"

// The lengths and angles that follow from a wheel's parameters. Metres and radians; y along the axle, 0 in the middle.
namespace tread::shape
{

/// Longest angle between neighbouring columns or rows of a wheel's mesh: 2 degrees, whose chords stay within 0.015 % of
/// the radius.
constexpr double longest_wheel_chord = 3.14159265358979323846 / 90;

/// InputError, naming `origin` and the key with its accepted range, unless the parameters fit together.
void check_wheel(const scene::WheelGenerator& wheel, const std::string& origin);

/// Radius of the drum, without grousers, at y.
double drum_radius(const scene::WheelGenerator& wheel, double y);

/// Radius of the drum's inner surface at y.
double inner_radius(const scene::WheelGenerator& wheel, double y);

/// Radius over the grousers at y.
double tip_radius(const scene::WheelGenerator& wheel, double y);

/// Inner radius of the flanges; without any, of the drum at its edges.
double rim_radius(const scene::WheelGenerator& wheel);

/// Angle of the grousers' middle lines at y, from where they are at y = 0.
double sweep(const scene::WheelGenerator& wheel, double y);

/// Half the angle that a grouser, as wide as at its foot, takes at a radius.
double half_angle(const scene::WheelGenerator& wheel, double radius);

/// Ascending y of the mesh's rows, symmetric about 0, which is one of them, as are the faces of flanges and web. Dense
/// enough that no step turns or curves more than a chord does.
std::vector<double> wheel_rows(const scene::WheelGenerator& wheel);

} // namespace tread::shape
