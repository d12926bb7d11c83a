#pragma once

#include "backend/array.hpp"
#include "backend/pack.hpp"
#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// What a wall of the domain does to the grid's velocity at its nodes and beyond.
enum class WallRule : std::int32_t
{
    open,
    slip,       ///< no velocity into the wall; sand may leave it
    fixed,      ///< no velocity: sand cannot come off it
    frictional, ///< as slip, and Coulomb's friction along the wall
    rough       ///< no velocity of sand that does not come off
};

/// [axis][0 = low side, 1 = high side].
struct GridWalls
{
    WallRule     rule[3][2];
    std::int32_t last_node[3]; ///< node on the high wall; the low wall's is 0
    double       friction;     ///< coefficient of the frictional walls
};

/// Whether any wall across an axis holds anything.
inline bool has_walls(const GridWalls& walls, int axis)
{
    return walls.rule[axis][0] != WallRule::open || walls.rule[axis][1] != WallRule::open;
}

/// Whether any wall holds anything.
inline bool has_walls(const GridWalls& walls)
{
    return has_walls(walls, 0) || has_walls(walls, 1) || has_walls(walls, 2);
}

/// Mass (kg) and velocity (m/s) of a node that walls hold together with others; all zero of any other.
template<class Real>
using WallNode = Pack<Real, 4>;

/// The node pages of which walls may hold nodes ("wall pages").
template<class Real>
struct WallPagesView
{
    std::int64_t        count;
    const std::int32_t* page;      ///< [count], node page, ascending
    const std::int32_t* number_of; ///< [node pages], its wall page, or -1; null where no wall holds anything
    const std::int32_t* neighbour; ///< [27 * count], wall page by direction, or -1
    WallNode<Real>*     node;      ///< [64 * count]

    TREAD_HD std::int32_t number(std::int64_t node_page) const
    {
        return number_of == nullptr ? -1 : number_of[node_page];
    }
};

/// Owner of what WallPagesView shows. No walls, no memory.
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
