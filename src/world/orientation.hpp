#pragma once

#include "backend/vector.hpp"
#include "scene/scene.hpp"

namespace tread::world
{

/// Rotation from a body's axes to the world's. Yaw turns about z and camber then about the heading.
Quat rotation_of(const scene::Orientation& orientation);

} // namespace tread::world
