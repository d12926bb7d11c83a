#pragma once

#include "kernels/mpm/scatter_kern.hpp"

namespace tread::mpm
{

/// Sand alone; sand that bodies touch; APIC, whose momentum varies over a point's stencil.
struct PlainLoad
{
    static constexpr bool force = false, affine = false;
};
struct ContactLoad
{
    static constexpr bool force = true, affine = false;
};
struct AffineLoad
{
    static constexpr bool force = true, affine = true;
};

/// Nodes of one layer of a tile.
constexpr int layer_nodes = tile_edge * tile_edge;

} // namespace tread::mpm
