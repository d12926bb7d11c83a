#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backend/vector.hpp"
#include "scene/scene.hpp"

// Regions of terrain and rocks: a region of a scene between two surfaces.
namespace tread::world
{

/// Height (m) as a function of x and y (m). Throws InputError with the place where there is none. Not thread-safe.
using HeightField = std::function<double(double x, double y)>;

/// `owner`: its name in messages, "[[terrain]] 0 height".
HeightField make_height_field(const scene::Height& height, const std::string& owner);

/// Space that points and rocks may fill. Surfaces that the scene omits are empty functions.
struct Space
{
    scene::Region region;
    HeightField   floor;
    HeightField   height;
};

/// `owner`: the table's name in messages, "[[terrain]] 0".
Space make_space(const scene::Region& region, const std::optional<scene::Height>& height,
                 const std::optional<scene::Height>& floor, const std::string& owner);

/// Bounding box of a region.
scene::Box bounds(const scene::Region& region);

/// Whether x lies in the region, without regard to its surfaces. Lower faces of boxes are included, upper ones are
/// not.
bool contains(const scene::Region& region, const Vec3<double>& x);

/// Returns floor(x, y) and height(x, y); minus and plus infinity where there is no surface.
std::pair<double, double> levels(const Space& space, double x, double y);

/// Whether x lies in the region and floor <= z < height.
bool contains(const Space& space, const Vec3<double>& x);

/// Volume, m3: integrates over columns of the plan, at least 512 each way and split at all faces of boxes; exact along
/// z, and for regions of boxes only.
double volume(const Space& space);

/// Describes a region in messages: "[[0, 0, 0], [1, 1, 0.2]]" or "the sphere ...".
std::string text_of(const scene::Region& region);

} // namespace tread::world
