#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.hpp"
#include "shape/mesh.hpp"

// Meshes made from parameters; closed by construction.
namespace tread::shape
{

/// Unit sphere: the icosahedron with its triangles quartered until it has `nodes` vertices (12, 42, 162, 642, 2562,
/// 10242); InputError, naming `origin`, for other counts.
TriangleMesh icosphere(int nodes, const std::string& origin);

/// Sphere of diameter 1 m, its vertices exactly on it.
TriangleMesh sphere_mesh(const scene::SphereGenerator& generator, const std::string& origin);

/// An irregular rock, star-shaped about a point inside: an ellipsoid with low-order bumps. Extents 1 : (1 + aspect)/2 :
/// aspect along x, y, z exactly; sphericity pi^(1/3) (6 V)^(2/3) / A (Wadell 1932) within 3 % of the request. Its
/// volume is that of a sphere of DIAMETER 1 m: an instance's scale is its equivalent diameter in metres. Equal
/// parameters give equal rocks on every machine. InputError, naming `origin`, if the sphericity cannot be reached, with
/// what can.
TriangleMesh rock_mesh(const scene::RockGenerator& generator, const std::string& origin);

/// A wheel about the y axis, centred at the origin: a drum with grousers flush with its width, open inside or with
/// flanges, web and hub. One closed surface; each grouser's section at a given y is a slab whose tip corners lie at the
/// outer radius. Chords of at most 2 degrees keep within 0.015 % of the radius. Triangles are at most 15 times as long
/// as high where walls, grousers and flanges measure 1.5 % of the radius or more. InputError, naming `origin`, if the
/// lengths do not fit together.
TriangleMesh wheel_mesh(const scene::WheelGenerator& generator, const std::string& origin);

double sphericity(const TriangleMesh& mesh);

} // namespace tread::shape
