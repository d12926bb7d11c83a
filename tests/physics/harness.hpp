#pragma once

#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "backend.hpp"
#include "run/phases.hpp"
#include "scene_text.hpp"
#include "solver/simulation.hpp"

// Runs a scene through its phases with the solver's components, on either backend, with a callback after every step.
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
        , phases_(scene_, tread::run::rolling_radii(scene_, world_))
    {
    }

    Simulation&         simulation() { return simulation_; }
    const scene::Scene& scene() const { return scene_; }
    const world::World& world() const { return world_; }
    double              time() const { return time_; }
    double              dt() const { return step_.dt; }

    /// Condition that ended the last phase.
    const tread::run::PhaseEnd& phase_end() const { return phases_.ending(); }

    /// Calls adjust(commands) before every step, to give named bodies commands that no phase can.
    void steer(std::function<void(std::vector<solver::BodyCommand>&)> adjust) { adjust_ = std::move(adjust); }

    /// Runs all phases; calls look(time) after every step.
    void run(const std::function<void(double)>& look = [](double) {})
    {
        while (!phases_.finished())
        {
            advance();
            look(time_);
            if (const auto body = phases_.lowered(); body && simulation_.measured())
            {
                phases_.weigh(time_, simulation_.carried(*body));
            }
            if (!phases_.over(time_, simulation_.unbalanced())) { continue; }
            phases_.advance(time_, std::vector<double>(scene_.bodies.size(), 0.0));
        }
    }

    /// Computes one step of the present phase, even if the phase is over.
    solver::TimeStep advance()
    {
        if (simulation_.measured())
        {
            step_ = solver::choose_step(scene_.time, simulation_.limits(), simulation_.pace(), step_.dt);
        }
        step_.dt = solver::fitted(step_.dt, phases_.latest_end() - time_);
        std::vector<solver::BodyCommand> commands;
        for (std::size_t b = 0; b < scene_.bodies.size(); ++b)
        {
            commands.push_back(phases_.command(b, time_ + step_.dt));
        }
        if (adjust_) { adjust_(commands); }
        simulation_.command(commands, phases_.phase().damping);
        const solver::TimeStep taken = simulation_.step(step_, time_, clock_);
        time_ += taken.dt;
        return taken;
    }

private:
    scene::Scene           scene_;
    world::World           world_;
    Simulation             simulation_;
    tread::run::PhaseClock phases_;
    solver::StageClock     clock_;
    solver::TimeStep       step_;
    double                 time_ = 0;

    std::function<void(std::vector<solver::BodyCommand>&)> adjust_;
};

/// One line of a physics test's report.
inline void report(const std::string& what, double measured, double expected, double tolerance, const std::string& why)
{
    std::cout << "[ physics  ] " << what << ": measured " << measured << ", expected " << expected << ", tolerance "
              << tolerance << " (" << why << ")\n";
}

} // namespace tread::test
