#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backend/vector.hpp"
#include "scene/scene.hpp"

// Where terrain and rocks are: a region of a scene between two surfaces.
namespace tread::world
{

/// A height (m) over the plan (m). Throws InputError that names the place where there is none. Not for threads.
using HeightField = std::function<double(double x, double y)>;

/// `owner` names it in messages: "[[terrain]] 0 height".
HeightField make_height_field(const scene::Height& height, const std::string& owner);

/// What points and rocks may fill. Surfaces that the scene leaves out are empty functions.
struct Space
{
    scene::Region region;
    HeightField   floor;
    HeightField   height;
};

/// `owner` names the table in messages: "[[terrain]] 0".
Space make_space(const scene::Region& region, const std::optional<scene::Height>& height,
                 const std::optional<scene::Height>& floor, const std::string& owner);

/// The least box around a region.
scene::Box bounds(const scene::Region& region);

/// Whether x lies in the region, surfaces apart. Lower faces of boxes belong to them, upper ones do not.
bool contains(const scene::Region& region, const Vec3<double>& x);

/// floor(x, y) and height(x, y); minus and plus infinity where there is no surface.
std::pair<double, double> levels(const Space& space, double x, double y);

/// Whether x lies in the region and floor <= z < height.
bool contains(const Space& space, const Vec3<double>& x);

/// m3: columns of the plan, at least 512 each way and cut at all faces of boxes; along z exact. For boxes alone exact.
double volume(const Space& space);

/// "[[0, 0, 0], [1, 1, 0.2]]" or "the sphere ...", for messages.
std::string text_of(const scene::Region& region);

} // namespace tread::world
