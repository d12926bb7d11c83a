#pragma once

#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "backend.hpp"
#include "run/time_loop.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"

// Runs a scene through its phases on either backend, with the program's loop and a callback after every step.
namespace tread::test
{

template<class Exec, class Real = double>
class Experiment
{
public:
    using Simulation = solver::Simulation<Exec, Real>;

    Experiment(const Exec& exec, const std::string& text)
        : Experiment(exec, load_text(text))
    {
    }

    Experiment(const Exec& exec, const scene::Scene& scene)
        : Experiment(exec, scene, world::build_world(scene))
    {
    }

    /// `decomposition`: null for the whole scene on this rank.
    Experiment(const Exec& exec, scene::Scene scene, world::World world,
               decomp::Decomposition<Exec>* decomposition = nullptr)
        : scene_(std::move(scene))
        , world_(std::move(world))
        , simulation_(exec, scene_, world_,
                      solver::make_plan(scene_, world_, decomposition != nullptr ? decomposition->ranks() : 1),
                      decomposition)
        , loop_(scene_, world_, simulation_)
    {
        world::release_rocks(world_);
        simulation_.begin();
    }
    Experiment(const Experiment&)            = delete;
    Experiment& operator=(const Experiment&) = delete;

    Simulation&         simulation() { return simulation_; }
    const scene::Scene& scene() const { return scene_; }
    const world::World& world() const { return world_; } ///< without its rocks, as in any run that has begun
    double              time() const { return loop_.progress.time; }

    /// s, length of the last step.
    double dt() const { return loop_.progress.last_dt; }

    /// Contact substeps of all steps.
    std::int64_t substeps() const { return loop_.progress.substeps; }

    /// Condition that ended the last phase.
    const tread::run::PhaseEnd& phase_end() const { return loop_.watch.ending; }

    /// Calls adjust(commands) before every step, to give named bodies commands that no phase can.
    void steer(std::function<void(std::vector<solver::BodyCommand>&)> adjust) { calls_.adjust = std::move(adjust); }

    /// Runs all phases; calls observe(time) after every step.
    void run(const std::function<void(double)>& observe = [](double) {})
    {
        calls_.after_step = [&] { observe(time()); };
        tread::run::run_phases(loop_, calls_);
    }

    /// Computes one step of the present phase, even if the phase is over; returns the step taken.
    solver::TimeStep advance() { return tread::run::take_step(loop_, calls_); }

private:
    scene::Scene                     scene_;
    world::World                     world_;
    Simulation                       simulation_;
    tread::run::TimeLoop<Exec, Real> loop_;
    tread::run::LoopCalls            calls_;
};

/// One line of a physics test's report.
inline void report(const std::string& what, double measured, double expected, double tolerance, const std::string& why)
{
    std::cout << "[ physics  ] " << what << ": measured " << measured << ", expected " << expected << ", tolerance "
              << tolerance << " (" << why << ")\n";
}

} // namespace tread::test
