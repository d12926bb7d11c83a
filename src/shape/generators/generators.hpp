#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.hpp"
#include "shape/mesh/mesh.hpp"

// Meshes generated from parameters; closed by construction.
namespace tread::shape
{

/// Unit sphere: an icosahedron with triangles subdivided into four until it has `nodes` vertices (12, 42, 162, 642,
/// 2562, 10242); InputError, naming `origin`, for other counts.
TriangleMesh icosphere(int nodes, const std::string& origin);

/// Sphere of diameter 1 m with its vertices exactly on the surface.
TriangleMesh sphere_mesh(const scene::SphereGenerator& generator, const std::string& origin);

/// An irregular rock: a ball cut by planes, dented by waves and stretched; star-shaped about a point inside. Aspect,
/// elongation, sphericity and solidity as `form_of` measures them on the mesh are within 3 % of the request. The
/// largest extent lies along x, the smallest along z. Its volume is that of a sphere of DIAMETER 1 m: an instance's
/// scale is its equivalent diameter in metres. Equal parameters give equal rocks on every machine. InputError, naming
/// `origin` and the attainable range, if the form cannot be reached. The mesh is finer than surface nodes require.
TriangleMesh rock_mesh(const scene::RockGenerator& generator, const std::string& origin);

/// A wheel about the y axis, centred at the origin: a drum with grousers flush with its width, open inside or with
/// flanges, web and hub. One closed surface; each grouser's section at a given y is a slab whose tip corners lie at the
/// outer radius. Chords of at most 2 degrees stay within 0.015 % of the radius. Triangles have an aspect of at most 15
/// if walls, grousers and flanges measure 1.5 % of the radius or more. InputError, naming `origin`, if the lengths are
/// incompatible.
TriangleMesh wheel_mesh(const scene::WheelGenerator& generator, const std::string& origin);

} // namespace tread::shape
