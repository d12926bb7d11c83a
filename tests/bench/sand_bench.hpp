#pragma once

#include <iostream>

#include <fmt/format.h>

#include "sand_bed.hpp"
#include "solver/sand/mpm_solver.hpp"
#include "timed.hpp"
#include "world/materials.hpp"

// Sand for timed steps, on one rank or on several.
namespace tread::bench
{

template<class Exec, class Real>
class SandBench
{
public:
    /// `decomposition`: null on one rank.
    SandBench(const Exec& exec, const MpmCase& what, const scene::Scene& scene, const world::World& world,
              decomp::Decomposition<Exec>* decomposition)
        : exec_(exec)
        , sand_(exec, scene, world,
                {.affine  = what.transfer != scene::Transfer::flip,
                 .plastic = scene::is_granular(what.law),
                 .coupled = false,
                 .capped  = what.law == scene::MaterialModel::drucker_prager_cap},
                decomposition)
        , ranks_(decomposition == nullptr ? 1 : decomposition->ranks())
        , dt_((what.per_cell == 1 ? 0.35 : 0.5) * sand_spacing / world::compression_wave_speed(scene.materials[0]))
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

    /// Wall time (s) of `steps` whole steps.
    double time_steps(int steps)
    {
        return timed(exec_,
                     [&]
                     {
                         for (int i = 0; i < steps; ++i) { step(); }
                     });
    }

    /// Prints the mean time (s) of each kernel over `steps` steps, with synchronisation after each.
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
            if (rank > 0) { return; } // rank 0 reports for all
            const double each = seconds[k] / steps;
            std::cout << fmt::format("    {:<7} {:9.1f} us  {:8.3f}e9 points/s\n", names[k], 1e6 * each,
                                     1e-9 * points / each);
        }
    }

private:
    /// Number of steps between reports: that of solver::Simulation for sand that moves half a cell in as many.
    static constexpr int report_every = 8;

    Exec                          exec_;
    solver::MpmSolver<Exec, Real> sand_;
    int                           ranks_;
    double                        dt_;
    int                           unreported_ = 0;
};

} // namespace tread::bench
