#pragma once

#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/transfers/scatter_kern.hpp"

namespace tread::mpm
{

/// What points bring besides mass, momentum and stress: the force of bodies that touch them; with APIC and AFLIP, a
/// momentum that varies over a point's stencil.
template<bool with_force, bool with_affine>
struct Load
{
    static constexpr bool force = with_force, affine = with_affine;
};

/// Nodes of one layer of a tile.
constexpr int layer_nodes = tile_edge * tile_edge;

} // namespace tread::mpm
