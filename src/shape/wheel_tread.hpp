#pragma once

#include "shape/rings.hpp"
#include "shape/wheel_form.hpp"

namespace tread::shape
{

/// Which end of the axle a surface lies towards: `right` is +y.
enum class Side
{
    left,
    right
};

/// Appends the surface of a side, made as if it were the right one; the left one is its mirror image.
void append(TriangleMesh& mesh, Side side, const Triangles& triangles);

/// Drum and grousers: where they end, across the axle.
struct TreadEdges
{
    Ring left, right;
};

/// Appends the outside of drum and grousers and the grousers' ends; returns the drum's rings at its edges, which have
/// the columns of `drum_ring`.
TreadEdges add_tread(TriangleMesh& mesh, const WheelGrid& grid);

/// Ring with the columns of the tread, those under the grousers' feet included, at y and a radius.
Ring drum_ring(TriangleMesh& mesh, const WheelGrid& grid, double y, double radius);

} // namespace tread::shape
