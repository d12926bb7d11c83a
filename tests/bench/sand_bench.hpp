#pragma once

#include <cmath>
#include <cstdint>
#include <iostream>

#include <fmt/format.h>

#include "mpm.hpp"
#include "solver/materials.hpp"
#include "solver/sand.hpp"
#include "timed.hpp"

// Sand whose steps are timed, on one rank or on several.
namespace tread::bench
{

constexpr double sand_spacing = 0.01; ///< m

struct Lattice
{
    std::int64_t across[3]; ///< points along each axis
    double       distance;  ///< m
};

inline const char* law_name(scene::MaterialModel law)
{
    if (law == scene::MaterialModel::mohr_coulomb) { return "mohr-coulomb"; }
    return law == scene::MaterialModel::drucker_prager ? "drucker-prager" : "elastic";
}

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
    scene.materials         = {sand};
    return scene;
}

inline solver::World make_world(const MpmCase& what, const scene::Scene& scene, const Lattice& lattice)
{
    solver::World world{};
    world.geometry = {sand_spacing, 0.5, {scene.domain.size[0], scene.domain.size[1], scene.domain.size[2]}};
    using mpm::WallRule;
    world.grid_walls.rule[0][0] = world.grid_walls.rule[0][1] = WallRule::slip;
    world.grid_walls.rule[1][0] = world.grid_walls.rule[1][1] = WallRule::slip;
    world.grid_walls.rule[2][0]                               = WallRule::fixed;
    world.grid_walls.rule[2][1]                               = WallRule::open;
    Vec3<double> corner                                       = Vec3<double>::Zero();
    for (int c = 0; c < 3; ++c)
    {
        const double size             = scene.domain.size[static_cast<std::size_t>(c)];
        world.grid_walls.last_node[c] = static_cast<std::int32_t>(std::lround(size / sand_spacing));
        if (c < 2 && what.state == SandState::collapsing) { corner[c] = size / 3; }
    }
    const double volume = std::pow(lattice.distance, 3), density = scene.materials[0].density;
    const double height = static_cast<double>(lattice.across[2]) * lattice.distance;
    const double k      = scene.materials[0].poisson / (1 - scene.materials[0].poisson);
    for (std::int64_t z = 0; z < lattice.across[2]; ++z)
    {
        for (std::int64_t y = 0; y < lattice.across[1]; ++y)
        {
            for (std::int64_t x = 0; x < lattice.across[0]; ++x)
            {
                const Vec3<double> place =
                    corner + lattice.distance * Vec3<double>(double(x) + 0.5, double(y) + 0.5, double(z) + 0.5);
                const double vertical = -9.81 * density * (height - place[2]);
                world.points.position.push_back(place);
                world.points.volume.push_back(volume);
                world.points.mass.push_back(density * volume);
                world.points.stress.push_back({k * vertical, k * vertical, vertical, 0, 0, 0});
                world.points.material.push_back(0);
            }
        }
    }
    return world;
}

template<class Exec, class Real>
class SandBench
{
public:
    /// `decomposition`: null on one rank.
    SandBench(const Exec& exec, const MpmCase& what, const scene::Scene& scene, const solver::World& world,
              decomp::Decomposition<Exec>* decomposition)
        : exec_(exec)
        , sand_(exec, scene, world, {what.transfer != scene::Transfer::flip, scene::is_granular(what.law), false},
                decomposition)
        , ranks_(decomposition == nullptr ? 1 : decomposition->ranks())
        , dt_((what.per_cell == 1 ? 0.35 : 0.5) * sand_spacing / solver::compression_wave_speed(scene.materials[0]))
    {
    }

    double dt() const { return dt_; }

    void step()
    {
        sand_.order();
        sand_.scatter();
        if (ranks_ > 1) { sand_.share(); }
        sand_.update_grid(dt_, 0);
        sand_.gather(dt_);
        if (++unreported_ < report_every) { return; }
        unreported_ = 0;
        sand_.report();
    }

    /// Seconds of `steps` whole steps.
    double time_steps(int steps)
    {
        return timed(exec_,
                     [&]
                     {
                         for (int i = 0; i < steps; ++i) { step(); }
                     });
    }

    /// Mean seconds of each kernel, over `steps` steps with a wait after each.
    void print_kernels(int steps, double points, int rank = 0)
    {
        const char* names[]    = {"order", "P2G", "grid", "G2P", "report", "halo"};
        double      seconds[6] = {};
        for (int i = 0; i < steps; ++i)
        {
            seconds[0] += timed(exec_, [&] { sand_.order(); });
            seconds[1] += timed(exec_, [&] { sand_.scatter(); });
            if (ranks_ > 1)
            {
                seconds[5] += timed(exec_, [&] { sand_.share(); });
            }
            seconds[2] += timed(exec_, [&] { sand_.update_grid(dt_, 0); });
            seconds[3] += timed(exec_, [&] { sand_.gather(dt_); });
            if (i % report_every == 0)
            {
                seconds[4] += timed(exec_, [&] { sand_.report(); });
            }
        }
        for (int k = 0; k < (ranks_ > 1 ? 6 : 5); ++k)
        {
            if (rank > 0) { return; } // rank 0's stand for all
            const double each = seconds[k] / steps;
            std::cout << fmt::format("    {:<7} {:9.1f} us  {:8.3f}e9 points/s\n", names[k], 1e6 * each,
                                     1e-9 * points / each);
        }
    }

private:
    /// As solver::Simulation does where sand moves half a cell in as many steps.
    static constexpr int report_every = 8;

    Exec                     exec_;
    solver::Sand<Exec, Real> sand_;
    int                      ranks_;
    double                   dt_;
    int                      unreported_ = 0;
};

} // namespace tread::bench
