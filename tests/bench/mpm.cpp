#include "mpm.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <fmt/format.h>

#include "sand_bench.hpp"
#include "scene/spellings.hpp"

namespace tread::bench
{
namespace
{

template<class Exec, class Real>
void run_on(const Exec& exec, const MpmCase& what)
{
    const Lattice         points = lattice(what);
    const scene::Scene    scene  = make_scene(what, points);
    const world::World    world  = make_world(what, scene, points);
    const auto            count  = static_cast<double>(world.sand.size());
    SandBench<Exec, Real> bench(exec, what, scene, world, nullptr);
    const double          height = static_cast<double>(points.across[2]) * points.distance;
    const bool            moving = what.state == SandState::collapsing;
    const int             before = moving ? static_cast<int>(0.7 * std::sqrt(height / 9.81) / bench.dt()) : 20;
    bench.time_steps(before);
    std::vector<double> times(3);
    for (double& time : times) { time = bench.time_steps(what.steps) / what.steps; }
    std::sort(times.begin(), times.end());
    std::cout << fmt::format(
        "{:.3g} points, {} a cell, {}, {}, {}: {:.1f} us a step, {:.3f}e9 points/s, {:.1f} bytes a "
        "point\n",
        count, what.per_cell, moving ? "collapsing" : "settled", scene::word_of(what.law),
        sizeof(Real) == 4 ? "single" : "double", 1e6 * times[1], 1e-9 * count / times[1],
        static_cast<double>(exec.counters->peak_bytes()) / count);
    bench.print_kernels(std::min(what.steps, 50), count);
    std::cout << std::flush;
}

template<class Exec>
void run_with(const Exec& exec, const MpmCase& what)
{
    if (what.precision == scene::Precision::single_) { run_on<Exec, float>(exec, what); }
    else { run_on<Exec, double>(exec, what); }
}

} // namespace

void run_mpm(const MpmCase& what)
{
    on_backend(what.backend, [&](const auto& exec) { run_with(exec, what); });
}

} // namespace tread::bench
