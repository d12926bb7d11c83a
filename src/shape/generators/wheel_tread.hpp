#pragma once

#include "shape/generators/rings.hpp"
#include "shape/generators/wheel_form.hpp"

namespace tread::shape
{

/// Side of the axle that a surface faces: `right` is +y.
enum class Side
{
    left,
    right
};

/// Appends the surface of a side, given as the right one; the left one is its mirror image.
void append(TriangleMesh& mesh, Side side, const Triangles& triangles);

/// Edges of drum and grousers across the axle.
struct TreadEdges
{
    Ring left, right;
};

/// Appends the outside of drum and grousers and the grousers' ends; returns the drum's rings at its edges, which have
/// the columns of `drum_ring`.
TreadEdges add_tread(TriangleMesh& mesh, const WheelGrid& grid);

/// Ring with the columns of the tread, including those under the grousers' feet, at y and a radius.
Ring drum_ring(TriangleMesh& mesh, const WheelGrid& grid, double y, double radius);

} // namespace tread::shape
