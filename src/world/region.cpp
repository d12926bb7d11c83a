#include "world/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/formula.hpp"
#include "world/raster.hpp"

namespace tread::world
{
namespace
{

using Interval = std::pair<double, double>;

/// Wraps `height` with an error where it is not finite.
HeightField checked(std::function<double(double, double)> height, std::string what)
{
    return [height = std::move(height), what = std::move(what)](double x, double y)
    {
        const double value = height(x, y);
        if (!std::isfinite(value))
        {
            throw InputError(fmt::format("{} is {} at x = {:.6g}, y = {:.6g} (m); accepted: finite where the region is",
                                         what, value, x, y));
        }
        return value;
    };
}

bool inside(const scene::Box& box, const Vec3<double>& x)
{
    for (std::size_t c = 0; c < 3; ++c)
    {
        const double at = x[static_cast<Eigen::Index>(c)];
        if (at < box.low[c] || at >= box.high[c]) { return false; }
    }
    return true;
}

bool over(const scene::Box& box, double x, double y)
{
    return x >= box.low[0] && x < box.high[0] && y >= box.low[1] && y < box.high[1];
}

/// Interval of the region in the column at (x, y), before exclusions; empty if the column misses it.
Interval span(const scene::Region& region, double x, double y)
{
    if (region.sphere)
    {
        const auto&  sphere = *region.sphere;
        const double square =
            sphere.radius * sphere.radius - std::pow(x - sphere.centre[0], 2) - std::pow(y - sphere.centre[1], 2);
        const double half = square > 0 ? std::sqrt(square) : 0;
        return {sphere.centre[2] - half, sphere.centre[2] + half};
    }
    const auto& box = *region.box;
    return over(box, x, y) ? Interval{box.low[2], box.high[2]} : Interval{0, 0};
}

/// m, length of a column outside `except`.
double free_length(const scene::Region& region, Interval column, double x, double y)
{
    std::vector<Interval> cuts;
    for (const scene::Box& cut : region.except)
    {
        if (over(cut, x, y)) { cuts.emplace_back(cut.low[2], cut.high[2]); }
    }
    std::sort(cuts.begin(), cuts.end());
    double length = 0, from = column.first;
    for (const auto& [low, high] : cuts)
    {
        length += std::max(0.0, std::min(low, column.second) - from);
        from = std::max(from, high);
    }
    return length + std::max(0.0, column.second - from);
}

/// Strips between the faces of all boxes along one axis of the plan, in order, split into columns.
std::vector<Interval> strips(const scene::Region& region, std::size_t axis)
{
    constexpr double    fewest = 512;
    const auto          box    = bounds(region);
    std::vector<double> faces{box.low[axis], box.high[axis]};
    for (const scene::Box& cut : region.except)
    {
        for (const double face : {cut.low[axis], cut.high[axis]})
        {
            if (face > box.low[axis] && face < box.high[axis]) { faces.push_back(face); }
        }
    }
    std::sort(faces.begin(), faces.end());
    std::vector<Interval> middles_and_widths;
    const double          extent = box.high[axis] - box.low[axis];
    for (std::size_t i = 1; i < faces.size(); ++i)
    {
        const double length = faces[i] - faces[i - 1];
        const double pieces = std::max(1.0, std::ceil(fewest * length / extent));
        for (double piece = 0; length > 0 && piece < pieces; ++piece)
        {
            middles_and_widths.emplace_back(faces[i - 1] + length * (piece + 0.5) / pieces, length / pieces);
        }
    }
    return middles_and_widths;
}

} // namespace

HeightField make_height_field(const scene::Height& height, const std::string& owner)
{
    if (const auto* formula = std::get_if<scene::Formula>(&height))
    {
        const auto evaluator = std::make_shared<scene::FormulaEvaluator>(formula->text);
        return checked([evaluator](double x, double y) { return (*evaluator)(x, y); },
                       fmt::format("{} = \"{}\"", owner, formula->text));
    }
    const auto& file   = std::get<scene::RasterFile>(height);
    const auto  raster = std::make_shared<const Raster>(read_raster(file));
    const auto  extent = file.extent.value();
    const auto  what   = fmt::format("{} from {}, which covers [[{}, {}], [{}, {}]],", owner, file.path, extent[0][0],
                                     extent[0][1], extent[1][0], extent[1][1]);
    return checked([raster, extent](double x, double y) { return bilinear(*raster, extent, x, y); }, what);
}

Space make_space(const scene::Region& region, const std::optional<scene::Height>& height,
                 const std::optional<scene::Height>& floor, const std::string& owner)
{
    Space space{region, {}, {}};
    if (floor) { space.floor = make_height_field(*floor, owner + " floor"); }
    if (height) { space.height = make_height_field(*height, owner + " height"); }
    return space;
}

scene::Box bounds(const scene::Region& region)
{
    if (region.box) { return *region.box; }
    const auto& sphere = *region.sphere;
    scene::Box  box;
    for (std::size_t c = 0; c < 3; ++c)
    {
        box.low[c]  = sphere.centre[c] - sphere.radius;
        box.high[c] = sphere.centre[c] + sphere.radius;
    }
    return box;
}

bool contains(const scene::Region& region, const Vec3<double>& x)
{
    if (region.box && !inside(*region.box, x)) { return false; }
    if (region.sphere)
    {
        const Vec3<double> centre(region.sphere->centre.data());
        if ((x - centre).squaredNorm() >= region.sphere->radius * region.sphere->radius) { return false; }
    }
    return std::none_of(region.except.begin(), region.except.end(),
                        [&](const scene::Box& cut) { return inside(cut, x); });
}

std::pair<double, double> levels(const Space& space, double x, double y)
{
    constexpr double far = std::numeric_limits<double>::infinity();
    return {space.floor ? space.floor(x, y) : -far, space.height ? space.height(x, y) : far};
}

bool contains(const Space& space, const Vec3<double>& x)
{
    if (!contains(space.region, x)) { return false; }
    const auto [low, high] = levels(space, x[0], x[1]);
    return low <= x[2] && x[2] < high;
}

double volume(const Space& space)
{
    double     sum     = 0;
    const auto along_y = strips(space.region, 1);
    for (const auto& [x, width] : strips(space.region, 0))
    {
        for (const auto& [y, depth] : along_y)
        {
            Interval column = span(space.region, x, y);
            if (!(column.first < column.second)) { continue; }
            const auto [low, high] = levels(space, x, y);
            column                 = {std::max(column.first, low), std::min(column.second, high)};
            if (column.first < column.second) { sum += width * depth * free_length(space.region, column, x, y); }
        }
    }
    return sum;
}

std::string text_of(const scene::Region& region)
{
    if (region.sphere)
    {
        const auto& sphere = *region.sphere;
        return fmt::format("of the sphere about [{}, {}, {}] with radius {} m", sphere.centre[0], sphere.centre[1],
                           sphere.centre[2], sphere.radius);
    }
    const auto& box = *region.box;
    return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", box.low[0], box.low[1], box.low[2], box.high[0], box.high[1],
                       box.high[2]);
}

} // namespace tread::world
