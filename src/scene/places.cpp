#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/ranges.hpp"

namespace tread::scene
{
namespace
{

void validate_box(const Scene& scene, const Box& box, const TableAt& at, Checker& checker)
{
    const auto& size = scene.domain.size;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (box.low[axis] < 0 || box.high[axis] > size[axis])
        {
            checker.report(at, "region", fmt::format("the box leaves the domain along {}", "xyz"[axis]),
                           fmt::format("0 to {} (m)", size[axis]));
        }
    }
}

void validate_sphere(const Scene& scene, const Sphere& sphere, const TableAt& at, Checker& checker)
{
    const auto& size = scene.domain.size;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (sphere.centre[axis] - sphere.radius < 0 || sphere.centre[axis] + sphere.radius > size[axis])
        {
            checker.report(at, "region", fmt::format("the sphere leaves the domain along {}", "xyz"[axis]),
                           fmt::format("0 to {} (m)", size[axis]));
        }
    }
}

void validate_region(const Scene& scene, const Region& region, const TableAt& at, Checker& checker)
{
    if (!checker.sound(at, {"region"})) { return; }
    if (region.box && region.sphere) { checker.report(at, "region", "both box and sphere", "one of box, sphere"); }
    else if (region.box) { validate_box(scene, *region.box, at, checker); }
    else if (region.sphere) { validate_sphere(scene, *region.sphere, at, checker); }
}

void validate_height(const std::optional<Height>& height, const TableAt& at, const std::string& key, Checker& checker)
{
    const auto* raster = height ? std::get_if<RasterFile>(&*height) : nullptr;
    if (raster == nullptr || !checker.sound(at, {key})) { return; }
    const auto& path = raster->path;
    const auto  is   = [&](const std::string& end) { return path.size() > 4 && path.substr(path.size() - 4) == end; };
    if (!is(".pgm") && !is(".csv"))
    {
        checker.report(at, key, fmt::format("unknown kind of file {}", path), "*.pgm | *.csv");
    }
}

/// Probability of an interval under the standard normal distribution; evaluated in the tail that avoids cancellation.
double probability_between(double low, double high)
{
    const double root = std::numbers::sqrt2;
    return low > 0 ? 0.5 * (std::erfc(low / root) - std::erfc(high / root))
                   : 0.5 * (std::erfc(-high / root) - std::erfc(-low / root));
}

struct CheckDiameter
{
    const TableAt& at;
    Checker&       checker;

    bool ordered(double low, double high) const
    {
        if (low < high) { return true; }
        checker.report(at, "diameter", fmt::format("low = {} is not below high = {}", low, high), "low < high");
        return false;
    }

    void operator()(double) const {}
    void operator()(const UniformDiameters& diameters) const { ordered(diameters.low, diameters.high); }
    void operator()(const PowerLawDiameters& diameters) const { ordered(diameters.low, diameters.high); }
    void operator()(const LogNormalDiameters& diameters) const
    {
        if (!ordered(diameters.low, diameters.high)) { return; }
        const auto   score = [&](double d) { return std::log(d / diameters.median) / diameters.deviation; };
        const double share = probability_between(score(diameters.low), score(diameters.high));
        if (share < 1e-6)
        {
            checker.report(at, "diameter",
                           fmt::format("a share of {:.1e} of this distribution lies between low and high", share),
                           "median and deviation that put at least 1e-6 of it there");
        }
    }
};

void validate_rocks(const Rocks& rocks, const TableAt& at, Checker& checker)
{
    if (checker.given(at, "from") != nullptr) { return; }
    const bool count    = checker.given(at, "count") != nullptr;
    const bool fraction = checker.given(at, "solid_fraction") != nullptr;
    if (count == fraction)
    {
        checker.report(at, "count", count ? "both count and solid_fraction" : "neither count nor solid_fraction",
                       "exactly one of count, solid_fraction");
    }
    if (checker.sound(at, {"diameter"})) { std::visit(CheckDiameter{at, checker}, rocks.diameter); }
}

template<class T>
void validate_places_of(const Scene& scene, const std::vector<T>& items, const std::string& table, Checker& checker)
{
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        const TableAt at{table, i};
        validate_height(items[i].height, at, "height", checker);
        validate_height(items[i].floor, at, "floor", checker);
        if (checker.sound({"domain"}, {"size"})) { validate_region(scene, items[i].region, at, checker); }
    }
}

/// Rocks and spheres have a diameter of 1 m at scale 1, which no body intends, so a diameter is required.
void validate_diameter(const Scene& scene, const Body& body, const TableAt& at, Checker& checker)
{
    const auto shape = std::find_if(scene.shapes.begin(), scene.shapes.end(),
                                    [&](const Shape& candidate) { return candidate.name == body.shape; });
    if (shape == scene.shapes.end() || checker.given(at, "diameter") != nullptr) { return; }
    const TableAt shape_at{"shape", static_cast<std::size_t>(shape - scene.shapes.begin())};
    const bool    sized = !std::holds_alternative<RockGenerator>(shape->source) &&
                       !std::holds_alternative<SphereGenerator>(shape->source);
    if (sized || !checker.sound(shape_at, {"generate", "file"})) { return; }
    checker.report(at, "diameter", fmt::format("missing; \"{}\" is generated without a size", body.shape),
                   length().text() + " (m)");
}

void validate_position(const Scene& scene, const Body& body, const TableAt& at, Checker& checker)
{
    const auto& size = scene.domain.size;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (body.position[axis] < 0 || body.position[axis] > size[axis])
        {
            checker.report(at, "position",
                           fmt::format("{} = {} is outside the domain", "xyz"[axis], body.position[axis]),
                           fmt::format("0 to {} (m)", size[axis]));
        }
    }
}

} // namespace

void validate_places(const Scene& scene, Checker& checker)
{
    validate_places_of(scene, scene.terrain, "terrain", checker);
    validate_places_of(scene, scene.rocks, "rocks", checker);
    for (std::size_t i = 0; i < scene.rocks.size(); ++i) { validate_rocks(scene.rocks[i], {"rocks", i}, checker); }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    {
        const TableAt at{"body", i};
        if (checker.sound(at, {"shape"})) { validate_diameter(scene, scene.bodies[i], at, checker); }
        if (checker.sound({"domain"}, {"size"}) && checker.sound(at, {"position"}))
        {
            validate_position(scene, scene.bodies[i], at, checker);
        }
    }
}

} // namespace tread::scene
