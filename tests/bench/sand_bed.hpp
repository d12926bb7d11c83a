#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "decomp/page_graph.hpp"
#include "mpm.hpp"
#include "world/world.hpp"

// A bed or a column of sand on a lattice; each rank generates only the points of its own pages.
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

/// Range [first, end) of points along each axis in one page.
struct PagePoints
{
    std::int64_t first[3];
    std::int64_t end[3];

    std::int64_t count() const { return (end[0] - first[0]) * (end[1] - first[1]) * (end[2] - first[2]); }
};

/// Start of each page of the lattice along one axis, and one past the end.
inline std::vector<std::pair<std::int32_t, std::int64_t>> page_starts(const mpm::GridGeometry& geometry, double corner,
                                                                      double distance, std::int64_t count)
{
    std::vector<std::pair<std::int32_t, std::int64_t>> starts;
    for (std::int64_t i = 0; i < count; ++i)
    {
        const Vec3<double> at   = Vec3<double>::Constant(corner + distance * (double(i) + 0.5));
        const std::int32_t page = mpm::page_of(mpm::cell_of(at, geometry.lattice())).x;
        if (starts.empty() || starts.back().first != page) { starts.emplace_back(page, i); }
    }
    starts.emplace_back(0, count);
    return starts;
}

using LatticePages = std::map<std::uint64_t, PagePoints>;

/// All pages of a lattice, computed without visiting its points.
inline LatticePages pages_of(const mpm::GridGeometry& geometry, const Vec3<double>& corner, const Lattice& lattice)
{
    std::vector<std::pair<std::int32_t, std::int64_t>> axes[3];
    for (int c = 0; c < 3; ++c) { axes[c] = page_starts(geometry, corner[c], lattice.distance, lattice.across[c]); }
    LatticePages pages;
    for (std::size_t z = 0; z + 1 < axes[2].size(); ++z)
    {
        for (std::size_t y = 0; y + 1 < axes[1].size(); ++y)
        {
            for (std::size_t x = 0; x + 1 < axes[0].size(); ++x)
            {
                const mpm::Index3 page{axes[0][x].first, axes[1][y].first, axes[2][z].first};
                pages[mpm::page_key(page)] = {{axes[0][x].second, axes[1][y].second, axes[2][z].second},
                                              {axes[0][x + 1].second, axes[1][y + 1].second, axes[2][z + 1].second}};
            }
        }
    }
    return pages;
}

inline decomp::PageGraph graph_of(const LatticePages& pages)
{
    std::vector<std::uint64_t> key;
    std::vector<double>        load;
    for (const auto& [page, points] : pages)
    {
        key.push_back(page);
        load.push_back(static_cast<double>(points.count()));
    }
    return decomp::page_graph(std::move(key), std::move(load));
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

/// Memory matters: a thousand million points must fit on the host.
inline void fill(world::HostPoints& points, const scene::Material& sand, const Vec3<double>& corner,
                 const Lattice& lattice, const std::vector<PagePoints>& pages)
{
    std::vector<std::int64_t> first{0};
    for (const PagePoints& page : pages) { first.push_back(first.back() + page.count()); }
    const auto   count  = static_cast<std::size_t>(first.back());
    const double volume = std::pow(lattice.distance, 3);
    const double height = static_cast<double>(lattice.across[2]) * lattice.distance;
    const double k      = sand.poisson / (1 - sand.poisson);
    points.position.resize(count);
    points.stress.resize(count);
    points.id.resize(count);
    points.volume.assign(count, volume);
    points.mass.assign(count, sand.density * volume);
    points.material.assign(count, 0);
#pragma omp parallel for
    for (std::size_t p = 0; p < pages.size(); ++p)
    {
        const PagePoints& page = pages[p];
        auto              at   = static_cast<std::size_t>(first[p]);
        for (std::int64_t z = page.first[2]; z < page.end[2]; ++z)
        {
            for (std::int64_t y = page.first[1]; y < page.end[1]; ++y)
            {
                for (std::int64_t x = page.first[0]; x < page.end[0]; ++x, ++at)
                {
                    points.position[at] =
                        corner + lattice.distance * Vec3<double>(double(x) + 0.5, double(y) + 0.5, double(z) + 0.5);
                    const double vertical = -9.81 * sand.density * (height - points.position[at][2]);
                    points.stress[at] << k * vertical, k * vertical, vertical, 0, 0, 0;
                    points.id[at] = static_cast<std::uint32_t>((z * lattice.across[1] + y) * lattice.across[0] + x);
                }
            }
        }
    }
}

/// World with the points of the pages for which owned(page key) holds.
template<class Owned>
world::World make_world(const MpmCase& what, const scene::Scene& scene, const Lattice& lattice, Owned owned)
{
    world::World            world = empty_world(scene);
    std::vector<PagePoints> own;
    for (const auto& [key, points] : pages_of(world.geometry, corner_of(what, scene), lattice))
    {
        if (owned(key)) { own.push_back(points); }
    }
    fill(world.points, scene.materials[0], corner_of(what, scene), lattice, own);
    return world;
}

} // namespace tread::bench
