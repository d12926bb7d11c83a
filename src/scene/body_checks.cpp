#include <algorithm>

#include <fmt/format.h>

#include "scene/checker.hpp"

namespace tread::scene
{
namespace
{

/// Checks that a body is turned in one way only, and by both keys that an axis needs.
void validate_orientation(const TableAt& at, Checker& checker)
{
    constexpr const char* accepted = "one of axis with angle_deg, rows, yaw_deg with or without camber_deg";
    const auto            given    = [&](const char* key) { return checker.given(at, key) != nullptr; };
    const bool            axis     = given("axis") || given("angle_deg");
    const bool            wheel    = given("yaw_deg") || given("camber_deg");
    if (axis + given("rows") + wheel > 1)
    {
        std::vector<std::string> found;
        for (const char* key : {"axis", "angle_deg", "rows", "yaw_deg", "camber_deg"})
        {
            if (given(key)) { found.emplace_back(key); }
        }
        checker.report(at, found.back(), fmt::format("found {}", fmt::join(found, " and ")), accepted);
        return;
    }
    for (const auto& [key, other] : {std::pair("axis", "angle_deg"), std::pair("angle_deg", "axis")})
    {
        if (given(other) && !given(key))
        {
            checker.report(at, key, fmt::format("missing; `{}` needs it", other), accepted);
        }
    }
}

} // namespace

bool is_weightless(const Scene& scene, const Checker& checker)
{
    return scene.domain.gravity == Vector3{} && checker.sound({"domain"}, {"gravity", "gravity_size"});
}

void validate_bodies(const Scene& scene, Checker& checker)
{
    const bool weightless = is_weightless(scene, checker);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    {
        const TableAt            at{"body", i};
        std::vector<std::string> given;
        for (const auto* key : {"density", "mass", "load"})
        {
            if (checker.given(at, key) != nullptr) { given.emplace_back(key); }
        }
        if (given.size() != 1)
        {
            const auto found = given.empty() ? "none of them" : fmt::format("{}", fmt::join(given, " and "));
            checker.report(at, given.empty() ? "density" : given.back(), "found " + found,
                           "exactly one of density, mass, load");
        }
        if (checker.sound(at, {})) { validate_orientation(at, checker); }
        if (weightless && checker.given(at, "load") != nullptr)
        {
            checker.report(at, "load", "a load needs gravity, and [domain] gravity is zero", "density or mass");
        }
    }
}

} // namespace tread::scene
