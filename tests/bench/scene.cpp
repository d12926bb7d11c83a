#include "scene.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "run/time_loop.hpp"
#include "scene/load.hpp"
#include "solver/ranks/page_loads.hpp"
#include "solver/simulation.hpp"
#include "timed.hpp"

namespace tread::bench
{
namespace
{

template<class Exec, class Real>
class SceneBench
{
public:
    /// `decomposition`: null on one rank.
    SceneBench(const Exec& exec, const scene::Scene& scene, const world::World& world,
               decomp::Decomposition<Exec>* decomposition)
        : exec_(exec)
        , scene_(scene)
        , plan_(solver::make_plan(scene, world, decomposition != nullptr ? decomposition->ranks() : 1))
        , simulation_(exec, scene, world, plan_, decomposition)
        , loop_(scene, world, simulation_)
    {
        simulation_.begin();
    }

    /// Wall time (s) of `steps` whole steps.
    double time_steps(int steps)
    {
        constexpr std::int64_t no_sample = 1; // a step in which stages are not synchronised
        loop_.clock.begin_step(no_sample);
        return timed(exec_, [&] { run(steps); });
    }

    /// Times of the stages over `steps` steps, with synchronisation after each stage.
    std::vector<io::StageReport> time_stages(int steps, int ranks)
    {
        loop_.clock = {};
        run(steps);
        return loop_.clock.reports(solver::stages(scene_, plan_, ranks));
    }

    double mean_substeps() const
    {
        return static_cast<double>(loop_.progress.substeps) / static_cast<double>(loop_.progress.steps);
    }

    const solver::Simulation<Exec, Real>& simulation() const { return simulation_; }

private:
    void run(int steps)
    {
        for (int i = 0; i < steps; ++i) { tread::run::take_step(loop_, {}); }
    }

    Exec                             exec_;
    const scene::Scene&              scene_;
    solver::Plan                     plan_;
    solver::Simulation<Exec, Real>   simulation_;
    tread::run::TimeLoop<Exec, Real> loop_;
};

/// Time of the slowest rank.
double of_all(const Communicator& communicator, double seconds)
{
    const std::vector<double> of_ranks = communicator.gather(seconds);
    return *std::max_element(of_ranks.begin(), of_ranks.end());
}

void print_stages(const Communicator& communicator, const std::vector<io::StageReport>& stages, int steps)
{
    for (const io::StageReport& stage : stages)
    {
        const std::vector<double> of_ranks = communicator.gather(1e6 * stage.seconds / steps);
        const auto [least, most]           = std::minmax_element(of_ranks.begin(), of_ranks.end());
        if (communicator.rank() > 0 || stage.calls == 0) { continue; }
        std::cout << fmt::format("    {:<26}{:9.1f} to {:9.1f} us\n", stage.name, *least, *most);
    }
}

template<class Exec, class Real>
void run_on(const Exec& exec, const Communicator& communicator, const SceneCase& what, const scene::Scene& scene)
{
    const world::World world = world::build_world(scene);
    const auto         count = static_cast<double>(world.sand.size());

    std::unique_ptr<decomp::Decomposition<Exec>> decomposition;
    std::string                                  partition = "one rank";
    if (communicator.size() > 1)
    {
        decomposition = std::make_unique<decomp::Decomposition<Exec>>(
            communicator, exec, decomp::DecompositionOptions{what.transport, decomp::Checksums::off});
        partition = solver::share_out(*decomposition, world);
    }
    SceneBench<Exec, Real> bench(exec, scene, world, decomposition.get());
    bench.time_steps(what.settle);
    std::vector<double> times(3);
    for (double& time : times)
    {
        communicator.barrier();
        time = of_all(communicator, bench.time_steps(what.steps) / what.steps);
    }
    std::sort(times.begin(), times.end());
    const double bytes = static_cast<double>(communicator.sum(exec.counters->peak_bytes())) / count;
    if (communicator.rank() == 0)
    {
        std::cout << fmt::format("{} ranks, {}: {:.4g} points, {} bodies, {:.1f} substeps, {:.1f} us a step, "
                                 "{:.3f}e9 points/s, {:.1f} bytes a point; {}\n",
                                 communicator.size(),
                                 decomposition ? decomposition->transport.description() : std::string("no transport"),
                                 count, world.bodies.size(), bench.mean_substeps(), 1e6 * times[1],
                                 1e-9 * count / times[1], bytes, partition);
        if (const decomp::BalanceRow* balance = bench.simulation().balance())
        {
            std::cout << fmt::format("    imbalance {:.3f}, {} repartitions, {} points moved\n", balance->imbalance,
                                     balance->repartitions, balance->points_moved);
        }
    }
    print_stages(communicator, bench.time_stages(what.steps, communicator.size()), what.steps);
    std::cout << std::flush;
}

} // namespace

void run_scene(const Communicator& communicator, const SceneCase& what)
{
    const scene::Scene scene = scene::load_scene(what.scene, what.overrides);
    const auto         run   = [&](const auto& exec)
    {
        using Exec = std::remove_cvref_t<decltype(exec)>;
        if (scene.numerics.precision == scene::Precision::single_)
        {
            run_on<Exec, float>(exec, communicator, what, scene);
        }
        else { run_on<Exec, double>(exec, communicator, what, scene); }
    };
    on_backend(what.backend, run, communicator.local_rank());
}

} // namespace tread::bench
