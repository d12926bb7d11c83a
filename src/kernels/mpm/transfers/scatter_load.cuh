#pragma once

#include "kernels/mpm/pages/page_list.hpp"
#include "kernels/mpm/transfers/scatter_kern.hpp"

namespace tread::mpm
{

/// Optional contributions of points besides mass, momentum and stress: the contact force of bodies; with affine
/// transfers (APIC, AFLIP), a momentum that varies over a point's stencil.
template<bool with_force, bool with_affine>
struct Load
{
    static constexpr bool force = with_force, affine = with_affine;
};

/// Number of nodes of one layer of a tile.
constexpr int layer_nodes = tile_edge * tile_edge;

} // namespace tread::mpm
