#include "world/refinement.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/lines.hpp"

namespace tread::world
{
namespace
{

/// Cells of the next coarser level between a box and a wall or the enclosing box. Parents of slave nodes, which lie up
/// to two cells outside the box for points that have just left it, must be neither held by a wall nor slaves
/// themselves.
constexpr std::int32_t margin = 4;

mpm::Lattice lattice_of(const scene::Scene& scene, int level)
{
    return mpm::level_lattice(mpm::make_lattice(scene.grid.spacing, 0.5), level);
}

/// m, low end of a cell along an axis.
double low_end(const mpm::Lattice& lattice, std::int32_t cell)
{
    return (cell + lattice.stencil_shift + lattice.node_shift) * lattice.spacing;
}

/// Range of the next box, in cells of the next coarser level.
struct Room
{
    std::int32_t low[3], high[3];
};

/// The domain, minus the margin where there are walls.
Room room_in_domain(const scene::Scene& scene)
{
    const scene::Walls&   walls      = scene.domain.walls;
    const scene::WallKind kind[3][2] = {{walls.x, walls.x}, {walls.y, walls.y}, {walls.bottom, walls.top}};
    Room                  room{};
    for (std::size_t c = 0; c < 3; ++c)
    {
        const auto last = static_cast<std::int32_t>(std::lround(scene.domain.size[c] / scene.grid.spacing));
        room.low[c]     = kind[c][0] == scene::WallKind::open ? -1 : margin;
        room.high[c]    = kind[c][1] == scene::WallKind::open ? last : last - margin - 1;
    }
    return room;
}

Room room_in_box(const mpm::CellBox& box)
{
    return {{box.low.x + margin, box.low.y + margin, box.low.z + margin},
            {box.high.x - margin, box.high.y - margin, box.high.z - margin}};
}

[[noreturn]] void refuse(const scene::Scene& scene, std::size_t box, std::size_t axis, const Room& room, int outer)
{
    const mpm::Lattice lattice = lattice_of(scene, outer);
    throw InputError(
        fmt::format("[grid] refine: box {} leaves too little along {}; accepted: from {:.6g} to {:.6g} m, {} "
                    "cells of {:.4g} m inside {}",
                    box, "xyz"[axis], low_end(lattice, room.low[axis]), low_end(lattice, room.high[axis]), margin,
                    lattice.spacing, outer == 0 ? "the walls" : "the box before"));
}

mpm::CellBox grown(const scene::Scene& scene, std::size_t number, const Room& room)
{
    const int          outer   = static_cast<int>(number);
    const mpm::Lattice lattice = lattice_of(scene, outer);
    const scene::Box&  box     = scene.grid.refine[number];
    const std::int32_t from    = mpm::level_offset(outer) * mpm::page_edge,
                       to      = mpm::level_offset(outer + 1) * mpm::page_edge;
    std::int32_t low[3], high[3];
    for (std::size_t c = 0; c < 3; ++c)
    {
        const double shift = lattice.stencil_shift + lattice.node_shift;
        low[c]             = static_cast<std::int32_t>(std::floor(box.low[c] * lattice.inverse_spacing - shift + 1e-9));
        high[c]            = static_cast<std::int32_t>(std::ceil(box.high[c] * lattice.inverse_spacing - shift - 1e-9));
        if (low[c] < room.low[c] || high[c] > room.high[c]) { refuse(scene, number, c, room, outer); }
        low[c]  = 2 * (low[c] - from) + to;
        high[c] = 2 * (high[c] - from) + to;
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

} // namespace

mpm::Refinement refinement_of(const scene::Scene& scene)
{
    mpm::Refinement refinement;
    scene::with_line_of(scene, "grid",
                        [&]
                        {
                            Room room = room_in_domain(scene);
                            for (std::size_t number = 0; number < scene.grid.refine.size(); ++number)
                            {
                                refinement.box[number] = grown(scene, number, room);
                                room                   = room_in_box(refinement.box[number]);
                            }
                        });
    refinement.levels = static_cast<int>(scene.grid.refine.size());
    return refinement;
}

int level_at(const scene::Scene& scene, const mpm::Refinement& refinement, const Vec3<double>& position)
{
    return mpm::level_of(mpm::page_of(mpm::finest_cell(lattice_of(scene, 0), refinement, position)));
}

scene::Box box_of(const scene::Scene& scene, const mpm::Refinement& refinement, int level)
{
    const mpm::Lattice  lattice = lattice_of(scene, level);
    const mpm::CellBox& box     = refinement.box[level - 1];
    return {{low_end(lattice, box.low.x), low_end(lattice, box.low.y), low_end(lattice, box.low.z)},
            {low_end(lattice, box.high.x), low_end(lattice, box.high.y), low_end(lattice, box.high.z)}};
}

} // namespace tread::world
