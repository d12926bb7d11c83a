#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scene/checker.hpp"

// Checks of shapes whose keys depend on each other.
namespace tread::scene
{
namespace
{

/// Round parts thinner than this share of their radius would come near the error of the chords.
constexpr double thinnest = 1e-3;

/// Checks that exactly one key says where a shape comes from.
void validate_source(const TableAt& at, Checker& checker)
{
    std::vector<std::string> given;
    for (const char* key : {"file", "generate", "assemble"})
    {
        if (checker.given(at, key) != nullptr) { given.emplace_back(key); }
    }
    if (given.size() != 1)
    {
        const std::string found = given.empty() ? "none of them" : fmt::format("{}", fmt::join(given, " and "));
        checker.report(at, "", "found " + found, "exactly one of file, generate, assemble");
    }
    for (const char* key : {"unit", "repair"})
    {
        if (checker.given(at, key) == nullptr || checker.given(at, "file") != nullptr) { continue; }
        checker.report(at, key, "may stand only with `file`");
    }
}

/// Generators without such keys, mesh files and assemblies.
template<class Source>
void validate_generator(const Source& /*source*/, const TableAt& /*at*/, Checker& /*checker*/)
{
}

void validate_generator(const WheelGenerator& wheel, const TableAt& at, Checker& checker)
{
    const auto table = checker.label(at) + ".generate";
    for (const auto* key : {"radius", "wall_thickness", "grousers", "grouser_height", "grouser_width"})
    {
        if (mentions(checker.problems, table, key)) { return; }
    }
    if (wheel.wall_thickness + wheel.grouser_height >= wheel.radius)
    {
        checker.report(at, "generate", "wall and grousers leave no room in the wheel",
                       fmt::format("wall_thickness + grouser_height < radius = {} (m)", wheel.radius));
    }
    const double circumference = 2 * std::numbers::pi * (wheel.radius - wheel.grouser_height);
    if (wheel.grousers * wheel.grouser_width >= circumference)
    {
        checker.report(at, "generate", "the grousers overlap",
                       fmt::format("grousers * grouser_width < {:.3g} (m)", circumference));
    }
}

void validate_generator(const PlateGenerator& plate, const TableAt& at, Checker& checker)
{
    if (plate.radius.has_value() != plate.size.has_value()) { return; }
    checker.report(at, "generate", plate.radius ? "both radius and size" : "neither radius nor size",
                   "exactly one of radius, size");
}

void validate_generator(const ConeGenerator& cone, const TableAt& at, Checker& checker)
{
    if (cone.shaft_radius > cone.base_radius)
    {
        checker.report(at, "generate", fmt::format("shaft_radius = {} is more than the base", cone.shaft_radius),
                       fmt::format("0 to base_radius = {} (m)", cone.base_radius));
    }
    if ((cone.shaft_radius > 0) != (cone.shaft_length > 0))
    {
        checker.report(at, "generate",
                       fmt::format("shaft_radius = {} with shaft_length = {}", cone.shaft_radius, cone.shaft_length),
                       "both, or neither, above 0");
    }
}

void validate_generator(const RingGenerator& ring, const TableAt& at, Checker& checker)
{
    const double widest = (1 - thinnest) * ring.outer_radius;
    if (ring.inner_radius > widest)
    {
        checker.report(at, "generate", fmt::format("inner_radius = {} leaves no ring", ring.inner_radius),
                       fmt::format("at most {:.6g} (m) with outer_radius = {}", widest, ring.outer_radius));
        return;
    }
    const double pitch    = 2 * ring.inner_radius * std::sin(std::numbers::pi / std::max(ring.vanes, 2));
    const double thickest = 0.9 * pitch;
    if (ring.vanes > 0 && ring.vane_thickness > thickest)
    {
        checker.report(at, "generate", fmt::format("vane_thickness = {}: the vanes meet", ring.vane_thickness),
                       fmt::format("at most {:.4g} (m) with {} vanes at inner_radius = {}", thickest, ring.vanes,
                                   ring.inner_radius));
    }
}

void validate_generator(const TubeGenerator& tube, const TableAt& at, Checker& checker)
{
    const double thin = thinnest * tube.radius, thick = (1 - thinnest) * tube.radius;
    if (tube.wall_thickness >= thin && tube.wall_thickness <= thick) { return; }
    checker.report(at, "generate", fmt::format("wall_thickness = {} is out of range", tube.wall_thickness),
                   fmt::format("{:.6g} to {:.6g} (m) with radius = {}", thin, thick, tube.radius));
}

void validate_generator(const FrameGenerator& frame, const TableAt& at, Checker& checker)
{
    if (frame.floor_thickness < frame.height) { return; }
    checker.report(at, "generate", fmt::format("floor_thickness = {} fills the frame", frame.floor_thickness),
                   fmt::format("below height = {} (m)", frame.height));
}

} // namespace

void validate_shapes(const Scene& scene, Checker& checker)
{
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    {
        const TableAt at{"shape", i};
        validate_source(at, checker);
        if (checker.sound(at, {"generate"}))
        {
            std::visit([&](const auto& source) { validate_generator(source, at, checker); }, scene.shapes[i].source);
        }
    }
    validate_assemblies(scene, checker);
}

} // namespace tread::scene
