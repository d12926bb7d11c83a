#pragma once

#include <string>

#include "scene/shape.hpp"
#include "shape/solids/solid.hpp"

namespace tread::shape
{

/// Makes the solid of a shape, in the frame of its source: generated, read from a file (relative to `directory`), or
/// united from the shapes of an assembly. InputError, naming the shape or the file, if that is impossible.
Solid solid_of(const scene::Shape& shape, const std::string& directory);

} // namespace tread::shape
