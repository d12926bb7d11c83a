#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace tread::world
{

/// Which pairs of materials touch in a phase, by index into Scene::materials; the last index is the domain's wall.
struct TouchTable
{
    std::size_t               sides; ///< materials and the wall
    std::vector<std::uint8_t> touch; ///< [sides x sides], row-major

    std::size_t wall() const { return sides - 1; }

    template<class A, class B>
    bool operator()(A a, B b) const
    {
        return touch[static_cast<std::size_t>(a) * sides + static_cast<std::size_t>(b)] != 0;
    }

    bool operator==(const TouchTable&) const = default;
};

TouchTable touch_table(const scene::Scene& scene, std::size_t phase);

} // namespace tread::world
