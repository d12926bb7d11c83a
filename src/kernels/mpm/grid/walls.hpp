#pragma once

#include "backend/array.hpp"
#include "backend/pack.hpp"
#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// Boundary condition of a domain wall on the grid velocity at its nodes and beyond.
enum class WallRule : std::int32_t
{
    open,
    slip,       ///< no velocity into the wall; sand may separate
    fixed,      ///< no velocity: sand cannot separate
    frictional, ///< like slip, with Coulomb friction along the wall
    rough       ///< no velocity unless the sand separates
};

/// Indexed by [axis][0 = low side, 1 = high side].
struct GridWalls
{
    WallRule     rule[3][2];
    std::int32_t last_node[3]; ///< node on the high wall; the low wall's node is 0
    double       friction;     ///< friction coefficient of the frictional walls
};

/// Whether any wall across an axis constrains anything.
inline bool has_walls(const GridWalls& walls, int axis)
{
    return walls.rule[axis][0] != WallRule::open || walls.rule[axis][1] != WallRule::open;
}

/// Whether any wall constrains anything.
inline bool has_walls(const GridWalls& walls)
{
    return has_walls(walls, 0) || has_walls(walls, 1) || has_walls(walls, 2);
}

/// Mass (kg) and velocity (m/s) of a node that walls constrain together with others; zero for other nodes.
template<class Real>
using WallNode = Pack<Real, 4>;

/// Node pages in which walls may constrain nodes ("wall pages").
template<class Real>
struct WallPagesView
{
    std::int64_t        count;
    const std::int32_t* page;      ///< [count], node page, ascending
    const std::int32_t* number_of; ///< [node pages], its wall page, or -1; null if no wall constrains anything
    const std::int32_t* neighbour; ///< [27 * count], wall page by direction, or -1
    WallNode<Real>*     node;      ///< [64 * count]

    TREAD_HD std::int32_t number(std::int64_t node_page) const
    {
        return number_of == nullptr ? -1 : number_of[node_page];
    }
};

/// Memory of WallPagesView; none is allocated without walls.
template<class Exec, class Real>
struct WallPages
{
    explicit WallPages(const Exec& exec)
        : page(exec, "wall pages")
        , number_of(exec, "wall pages of node pages")
        , neighbour(exec, "neighbours of wall pages")
        , node(exec, "wall nodes")
    {
    }

    WallPagesView<Real> view() { return {page.size(), page.data(), number_of.data(), neighbour.data(), node.data()}; }

    Array<Exec, std::int32_t>   page;
    Array<Exec, std::int32_t>   number_of;
    Array<Exec, std::int32_t>   neighbour;
    Array<Exec, WallNode<Real>> node;
};

} // namespace tread::mpm
