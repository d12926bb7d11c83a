#include "shape/generators/wheel_form.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tread::shape
{
namespace
{

/// Largest step along y between rows.
double row_step(const scene::WheelGenerator& wheel)
{
    const double half = 0.5 * wheel.width;
    // Twice a chord keeps the triangles of the tread well shaped.
    double step = 2 * longest_wheel_chord * drum_radius(wheel, 0);
    // A tenth of half the width leaves an error of 1/400 of the parabola's height between it and its chords.
    if (wheel.crown > 0 || wheel.grouser_shape == scene::GrouserShape::curved) { step = std::min(step, 0.1 * half); }
    const double steepest = std::abs(sweep(wheel, half)) * (wheel.grouser_shape == scene::GrouserShape::curved ? 2 : 1);
    if (steepest > 0) { step = std::min(step, half * longest_wheel_chord / steepest); }
    return step;
}

std::vector<double> wheel_rows(const scene::WheelGenerator& wheel)
{
    std::vector<double> stops{0.0};
    if (wheel.hub_radius > 0) { stops.push_back(0.5 * wheel.web_thickness); }
    if (wheel.rim_height > 0) { stops.push_back(0.5 * wheel.width - wheel.rim_thickness); }
    stops.push_back(0.5 * wheel.width);

    const double        longest = row_step(wheel);
    std::vector<double> upper;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i)
    {
        const double way   = stops[i + 1] - stops[i];
        const int    steps = steps_over(way, longest);
        for (int step = 1; step < steps; ++step) { upper.push_back(stops[i] + way * step / steps); }
        upper.push_back(stops[i + 1]);
    }

    std::vector<double> rows;
    for (auto y = upper.rbegin(); y != upper.rend(); ++y) { rows.push_back(-*y); }
    rows.push_back(0);
    rows.insert(rows.end(), upper.begin(), upper.end());
    return rows;
}

} // namespace

double drum_radius(const scene::WheelGenerator& wheel, double y)
{
    const double edge = 2 * y / wheel.width;
    return wheel.radius - (wheel.grousers > 0 ? wheel.grouser_height : 0.0) - wheel.crown * edge * edge;
}

double inner_radius(const scene::WheelGenerator& wheel, double y)
{
    return drum_radius(wheel, y) - wheel.wall_thickness;
}

double tip_radius(const scene::WheelGenerator& wheel, double y) { return drum_radius(wheel, y) + wheel.grouser_height; }

double rim_radius(const scene::WheelGenerator& wheel)
{
    return inner_radius(wheel, 0.5 * wheel.width) - wheel.rim_height;
}

double sweep(const scene::WheelGenerator& wheel, double y)
{
    if (wheel.grousers == 0) { return 0; }
    const double ends = wheel.grouser_sweep_deg / 180 * std::numbers::pi;
    const double edge = std::abs(2 * y / wheel.width);
    switch (wheel.grouser_shape)
    {
    case scene::GrouserShape::chevron:
        return ends * edge;
    case scene::GrouserShape::curved:
        return ends * edge * edge;
    case scene::GrouserShape::straight:
        break;
    }
    return 0;
}

double half_angle(const scene::WheelGenerator& wheel, double radius)
{
    return wheel.grousers > 0 ? std::asin(0.5 * wheel.grouser_width / radius) : 0.0;
}

int steps_over(double way, double longest) { return std::max(1, static_cast<int>(std::ceil(way / longest - 1e-9))); }

WheelGrid wheel_grid(const scene::WheelGenerator& wheel)
{
    WheelGrid grid{};
    grid.wheel        = wheel;
    grid.rows         = wheel_rows(wheel);
    grid.chord        = longest_wheel_chord * drum_radius(wheel, 0);
    grid.pitches      = std::max(wheel.grousers, 1);
    grid.pitch        = 2 * std::numbers::pi / grid.pitches;
    const double foot = 2 * half_angle(wheel, drum_radius(wheel, 0));
    grid.gap_columns  = steps_over(grid.pitch - foot, longest_wheel_chord);
    grid.foot_columns = wheel.grousers > 0 ? steps_over(foot, longest_wheel_chord) : 0;
    // Steeply swept grousers have narrow rows: lower levels keep the triangles of their sides well shaped.
    grid.levels = steps_over(wheel.grouser_height, 1.5 * grid.chord);
    return grid;
}

} // namespace tread::shape
