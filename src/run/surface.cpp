#include "run/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/state_file.hpp"

namespace tread::run
{
namespace
{

constexpr double no_height      = std::numeric_limits<double>::quiet_NaN();
constexpr int    most_samples   = 64; ///< along each side of a footprint
constexpr int    fewest_samples = 4;

int samples_along(double side, double column)
{
    return std::clamp(static_cast<int>(2 * side / column), fewest_samples, most_samples);
}

/// Position of the middle of a sample, from -0.5 to 0.5 of a side.
double sample_place(int sample, int count) { return (sample + 0.5) / count - 0.5; }

/// Unit vector along x where the axle stands upright.
Eigen::Vector2d plan_direction(const Vec3<double>& axle)
{
    const Eigen::Vector2d plan(axle[0], axle[1]);
    return plan.norm() > 1e-6 ? Eigen::Vector2d(plan.normalized()) : Eigen::Vector2d::UnitX();
}

} // namespace

std::vector<Footprint> footprints(const world::World& world)
{
    std::vector<Footprint> all;
    for (std::size_t b = 0; b < static_cast<std::size_t>(world.bodies.named); ++b)
    {
        const auto&  form  = world::template_of(world, b);
        const double scale = world.bodies.scale[b];
        const double side  = form.is_wheel ? form.wheel.radius : form.bounding_radius;
        all.push_back({scale * side, scale * (form.is_wheel ? form.wheel.width : side), scale * form.bounding_radius});
    }
    return all;
}

SurfaceMap::SurfaceMap(const scene::Scene& scene, const world::World& world)
    : lattice_(world::column_lattice(scene, world))
    , footprints_(footprints(world))
    , height_(static_cast<std::size_t>(lattice_.size()), no_height)
    , pressed_(height_.size(), 0)
{
}

void SurfaceMap::renew(const std::vector<double>& heights)
{
    for (std::size_t c = 0; c < height_.size(); ++c)
    {
        if (pressed_[c] == 0) { height_[c] = heights[c]; }
    }
}

/// First and last column along an axis within `reach` of `place`.
std::pair<std::int64_t, std::int64_t> SurfaceMap::columns_within(std::size_t axis, double place, double reach) const
{
    const double last = static_cast<double>(lattice_.count[axis] - 1), width = lattice_.width[axis];
    return {static_cast<std::int64_t>(std::clamp(std::floor((place - reach) / width), 0.0, last)),
            static_cast<std::int64_t>(std::clamp(std::floor((place + reach) / width), 0.0, last))};
}

void SurfaceMap::press(const std::vector<solver::BodyRow>& bodies)
{
    if (height_.empty()) { return; }
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const Vec3<double>& place = bodies[b].position;
        const double        reach = footprints_[b].reach + 0.5 * std::hypot(lattice_.width[0], lattice_.width[1]);
        const auto [left, right]  = columns_within(0, place[0], reach);
        const auto [near, far]    = columns_within(1, place[1], reach);
        for (std::int64_t j = near; j <= far; ++j)
        {
            for (std::int64_t i = left; i <= right; ++i)
            {
                const auto   c    = static_cast<std::size_t>(i + lattice_.count[0] * j);
                const double away = std::hypot(place[0] - middle(0, i), place[1] - middle(1, j));
                if (bodies[b].lowest < height_[c] && away < reach) { pressed_[c] = 1; }
            }
        }
    }
}

/// Interpolates bilinearly between the middles of columns with terrain; NaN where none of the four has.
double SurfaceMap::at(double x, double y) const
{
    const double u = x / lattice_.width[0] - 0.5, v = y / lattice_.width[1] - 0.5;
    const auto   i = static_cast<std::int64_t>(std::floor(u)), j = static_cast<std::int64_t>(std::floor(v));
    double       sum = 0, weights = 0;
    for (std::int64_t k = 0; k < 4; ++k)
    {
        const std::int64_t right = k % 2, up = k / 2;
        const double       weight =
            std::abs(static_cast<double>(i + 1 - right) - u) * std::abs(static_cast<double>(j + 1 - up) - v);
        const std::int64_t column = std::clamp<std::int64_t>(i + right, 0, lattice_.count[0] - 1) +
                                    lattice_.count[0] * std::clamp<std::int64_t>(j + up, 0, lattice_.count[1] - 1);
        const double height = height_[static_cast<std::size_t>(column)];
        if (std::isnan(height)) { continue; }
        sum += weight * height;
        weights += weight;
    }
    return weights > 0 ? sum / weights : no_height;
}

double SurfaceMap::nearest(double x, double y) const
{
    double least = std::numeric_limits<double>::infinity(), height = 0;
    for (std::size_t c = 0; c < height_.size(); ++c)
    {
        const auto   column = static_cast<std::int64_t>(c);
        const double away =
            std::hypot(x - middle(0, column % lattice_.count[0]), y - middle(1, column / lattice_.count[0]));
        if (std::isnan(height_[c]) || away >= least) { continue; }
        least  = away;
        height = height_[c];
    }
    return height;
}

double SurfaceMap::under(std::size_t body, const solver::BodyRow& row) const
{
    if (height_.empty()) { return 0; }
    const Footprint&      print  = footprints_[body];
    const Eigen::Vector2d along  = plan_direction(row.axle), across(along[1], -along[0]);
    const double          column = std::min(lattice_.width[0], lattice_.width[1]);
    const int             rows = samples_along(print.length, column), columns = samples_along(print.width, column);

    double sum   = 0;
    int    count = 0;
    for (int i = 0; i < rows; ++i)
    {
        for (int j = 0; j < columns; ++j)
        {
            const Eigen::Vector2d offset =
                print.length * sample_place(i, rows) * across + print.width * sample_place(j, columns) * along;
            const double height = at(row.position[0] + offset[0], row.position[1] + offset[1]);
            if (std::isnan(height)) { continue; }
            sum += height;
            ++count;
        }
    }
    return count > 0 ? sum / count : nearest(row.position[0], row.position[1]);
}

void SurfaceMap::transfer(solver::StateFile& file)
{
    file.common("surface/height", height_,
                solver::accept::all(solver::accept::rows(height_.size()), solver::accept::finite_or_none()));
    file.common("surface/pressed", pressed_,
                solver::accept::all(solver::accept::rows(height_.size()), solver::accept::within(0, 1)));
}

} // namespace tread::run
