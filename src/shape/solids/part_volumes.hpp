#pragma once

#include <string>

#include "shape/distance/winding_number.hpp"
#include "shape/mesh/mesh.hpp"

namespace tread::shape
{

/// Throws InputError that names `origin` and the volumes if the volume (m3) of a solid differs by over 20 % from the
/// sum of its parts' own volumes; parts that face inwards count as negative, and volume shared by several parts counts
/// once. `surface` holds all parts; own volumes of a closed one are exact, those of an open one are sampled.
void require_volume_of_parts(const TriangleMesh& surface, double volume, const std::string& origin);

} // namespace tread::shape
