#pragma once

#include <cmath>
#include <cstdint>

#include "mpm.hpp"
#include "world/world.hpp"

// A bed or a column of sand on a lattice.
namespace tread::bench
{

constexpr double sand_spacing = 0.01; ///< m

struct Lattice
{
    std::int64_t across[3]; ///< points along each axis
    double       distance;  ///< m
};

/// A bed four times as wide as high, or a column twice as high as wide, of about `points`.
inline Lattice lattice(const MpmCase& what)
{
    const double per_axis = std::round(std::cbrt(what.per_cell));
    const double cells    = static_cast<double>(what.points) / what.per_cell;
    const bool   column   = what.state == SandState::collapsing;
    const double width    = column ? std::cbrt(cells / 2) : std::cbrt(4 * cells);
    const double height   = column ? 2 * width : width / 4;
    const auto   whole    = [&](double length) { return static_cast<std::int64_t>(std::round(length) * per_axis); };
    return {{whole(width), whole(width), whole(height)}, sand_spacing / per_axis};
}

inline scene::Scene make_scene(const MpmCase& what, const Lattice& points)
{
    scene::Scene scene;
    const double room = what.state == SandState::collapsing ? 3 : 1;
    for (std::size_t c = 0; c < 3; ++c)
    {
        const double extent  = static_cast<double>(points.across[c]) * points.distance;
        scene.domain.size[c] = (c == 2 ? 1.5 : room) * extent;
    }
    scene.domain.gravity = {0, 0, -9.81};
    scene.domain.walls = {scene::WallKind::slip, scene::WallKind::slip, scene::WallKind::fixed, scene::WallKind::open};
    scene.grid.spacing = sand_spacing;
    scene.numerics.precision = what.precision;
    scene.numerics.transfer  = what.transfer;
    scene::Material sand;
    sand.name               = "sand";
    sand.model              = what.law;
    sand.density            = 1600;
    sand.young              = 1e6;
    sand.poisson            = 0.3;
    sand.friction_angle_deg = 30;
    // The laws that ask for them see sand of medium density, and a cap that yields at the bottom of the bed.
    sand.relative_density = 0.5;
    sand.void_ratio_min   = 0.5;
    sand.void_ratio_max   = 0.9;
    sand.cap_pressure     = 1e3;
    sand.cap_index        = 0.01;
    scene.materials       = {sand};
    return scene;
}

inline Vec3<double> corner_of(const MpmCase& what, const scene::Scene& scene)
{
    const bool column = what.state == SandState::collapsing;
    return column ? Vec3<double>(scene.domain.size[0] / 3, scene.domain.size[1] / 3, 0) : Vec3<double>::Zero();
}

/// World with walls and grid, without points.
inline world::World empty_world(const scene::Scene& scene)
{
    world::World world{};
    world.geometry = {sand_spacing, 0.5, {scene.domain.size[0], scene.domain.size[1], scene.domain.size[2]}};
    using mpm::WallRule;
    world.grid_walls.rule[0][0] = world.grid_walls.rule[0][1] = WallRule::slip;
    world.grid_walls.rule[1][0] = world.grid_walls.rule[1][1] = WallRule::slip;
    world.grid_walls.rule[2][0]                               = WallRule::fixed;
    world.grid_walls.rule[2][1]                               = WallRule::open;
    for (int c = 0; c < 3; ++c)
    {
        const double size             = scene.domain.size[static_cast<std::size_t>(c)];
        world.grid_walls.last_node[c] = static_cast<std::int32_t>(std::lround(size / sand_spacing));
    }
    return world;
}

/// World with the points of the lattice.
inline world::World make_world(const MpmCase& what, const scene::Scene& scene, const Lattice& lattice)
{
    world::World       world  = empty_world(scene);
    const Vec3<double> corner = corner_of(what, scene);
    const double       volume = std::pow(lattice.distance, 3);
    world.sand.kinds          = {{volume, scene.materials[0].density * volume}};
    world.sand.velocity       = {Vec3<double>::Zero()};
    const auto along          = [&](int c, std::int64_t i) { return corner[c] + lattice.distance * (double(i) + 0.5); };
    for (std::int64_t z = 0; z < lattice.across[2]; ++z)
    {
        for (std::int64_t y = 0; y < lattice.across[1]; ++y)
        {
            append(world.sand, {corner[0], lattice.distance, along(1, y), along(2, z), 0,
                                static_cast<std::uint32_t>(lattice.across[0]), 0});
        }
    }
    return world;
}

} // namespace tread::bench
