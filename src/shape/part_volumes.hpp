#pragma once

#include <string>

#include "shape/mesh.hpp"
#include "shape/winding_number.hpp"

namespace tread::shape
{

/// Throws InputError that names `origin` and the figures if the volume (m3) taken for a solid differs by over 20 % from
/// the sum of its parts' own volumes, where parts that face inwards count negative and what several parts hold counts
/// once. The surface is that of all parts; a closed one has exact own volumes, those of an open one are sampled.
void require_volume_of_parts(const TriangleMesh& surface, double volume, const std::string& origin);

} // namespace tread::shape
