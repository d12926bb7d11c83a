#include <algorithm>
#include <memory>
#include <vector>

#include "sand_bench.hpp"
#include "solver/ranks/page_loads.hpp"

namespace tread::bench
{
namespace
{

template<class Exec, class Real>
void run_on(const Exec& exec, const Communicator& communicator, const MpmCase& what, decomp::TransportChoice transport)
{
    const Lattice      points = lattice(what);
    const scene::Scene scene  = make_scene(what, points);
    const world::World world  = make_world(what, scene, points);
    const auto         count  = static_cast<double>(world.sand.size());

    std::unique_ptr<decomp::Decomposition<Exec>> decomposition;
    std::string                                  partition = "one rank";
    if (communicator.size() > 1)
    {
        decomposition = std::make_unique<decomp::Decomposition<Exec>>(
            communicator, exec, decomp::DecompositionOptions{transport, decomp::Checksums::off});
        partition = solver::share_out(*decomposition, world);
    }
    SandBench<Exec, Real> bench(exec, what, scene, world, decomposition.get());
    bench.time_steps(20);
    std::vector<double> times(3);
    for (double& time : times)
    {
        communicator.barrier();
        const std::vector<double> of_ranks = communicator.gather(bench.time_steps(what.steps) / what.steps);
        time                               = *std::max_element(of_ranks.begin(), of_ranks.end());
    }
    std::sort(times.begin(), times.end());
    const double bytes = static_cast<double>(communicator.sum(exec.counters->peak_bytes())) / count;
    if (communicator.rank() == 0)
    {
        std::cout << fmt::format("{} ranks, {}: {:.4g} points, {:.1f} us a step, {:.3f}e9 points/s, {:.1f} bytes a "
                                 "point; {}\n",
                                 communicator.size(),
                                 decomposition ? decomposition->transport.description() : std::string("no transport"),
                                 count, 1e6 * times[1], 1e-9 * count / times[1], bytes, partition);
    }
    bench.print_kernels(std::min(what.steps, 50), count, communicator.rank());
    std::cout << std::flush;
}

} // namespace

void run_scaling(const Communicator& communicator, MpmCase what, Scaling scaling, decomp::TransportChoice transport)
{
    if (scaling == Scaling::weak) { what.points *= communicator.size(); }
    const auto run = [&](const auto& exec)
    {
        using Exec = std::remove_cvref_t<decltype(exec)>;
        if (what.precision == scene::Precision::single_) { run_on<Exec, float>(exec, communicator, what, transport); }
        else { run_on<Exec, double>(exec, communicator, what, transport); }
    };
    on_backend(what.backend, run, communicator.local_rank());
}

} // namespace tread::bench
