#include "dem.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <fmt/format.h>

#include "timed.hpp"

#include "run/phase_commands.hpp"
#include "run/phase_end.hpp"
#include "scene/load.hpp"
#include "solver/bodies/dem_solver.hpp"

namespace tread::bench
{
namespace
{

constexpr double share_of_contact = 0.2; ///< of a substep over sqrt(m / sum K), as in solver::choose_step
constexpr double damping          = 0.5; ///< while the bed settles

template<class Exec>
class DemBench
{
public:
    DemBench(const Exec& exec, const scene::Scene& scene, const world::World& world, int substeps)
        : exec_(exec)
        , scene_(scene)
        , rigid_(exec, scene, world, solver::make_plan(scene, world))
        , phase_(tread::run::first_phase(scene))
        , rolling_radii_(tread::run::rolling_radii(scene, world))
        , substeps_(substeps)
    {
        command();
        rigid_.find_pairs(1e-4);
        choose_substep();
    }

    /// Result of settling a bed.
    struct Rest
    {
        double time;           ///< s, duration
        double out_of_balance; ///< sum over bodies of the net force's magnitude, over the weight
    };

    /// Runs until the bed is at rest, for at most `longest` (s).
    Rest settle(double longest)
    {
        constexpr int    check_every = 64;   // steps
        constexpr double at_rest     = 1e-3; // of the weight: a tenth of a phase's default
        const auto&      g           = scene_.domain.gravity;
        const double     weight      = rigid_.mass() * std::hypot(g[0], g[1], g[2]);
        double           at = 0, still_since = 0;
        for (std::int64_t number = 1; at < longest; ++number)
        {
            step(damping);
            at += substeps_ * dt_;
            choose_substep();
            if (number % check_every != 0) { continue; }
            const double out_of_balance = rigid_.report(at).net_force / weight;
            if (!(out_of_balance <= at_rest)) { still_since = at; }
            if (at - still_since >= tread::run::equilibrium_hold) { break; }
        }
        return {at, rigid_.report(at).net_force / weight};
    }

    /// Continues with the scene's second phase for `time` (s).
    void stir(double time)
    {
        tread::run::enter_next(phase_, 0, std::vector<double>(scene_.bodies.size(), 0.0));
        command();
        for (double at = 0; at < time; at += substeps_ * dt_)
        {
            step(0);
            choose_substep();
        }
    }

    /// Number of pair searches since the start.
    std::int64_t searches() const
    {
        const auto& launches = exec_.counters->launches();
        const auto  found    = launches.find("write pairs");
        return found == launches.end() ? 0 : found->second;
    }

    double               substep() const { return dt_; }
    solver::ContactCount contacts() { return rigid_.count_contacts(); }

    /// Seconds per substep, including pair searches.
    double time_substeps(int steps)
    {
        const double seconds = timed(exec_,
                                     [&]
                                     {
                                         for (int i = 0; i < steps; ++i) { step(0); }
                                     });
        return seconds / (steps * substeps_);
    }

    void print_parts(int steps, double bodies)
    {
        double search = 0, contact = 0, move = 0;
        for (int i = 0; i < steps; ++i)
        {
            search += timed(exec_, [&] { rigid_.find_pairs(substeps_ * dt_); });
            for (int s = 0; s < substeps_; ++s)
            {
                contact += timed(exec_, [&] { rigid_.contact(dt_); });
                move += timed(exec_, [&] { rigid_.move(dt_, 0); });
            }
        }
        const auto print = [&](const char* name, double seconds)
        {
            std::cout << fmt::format("    {:<8} {:9.1f} us a substep  {:8.3f}e6 body-steps/s\n", name, 1e6 * seconds,
                                     1e-6 * bodies / seconds);
        };
        print("pairs", search / (steps * substeps_));
        print("contact", contact / (steps * substeps_));
        print("move", move / (steps * substeps_));
    }

private:
    void command()
    {
        std::vector<solver::BodyCommand> commands;
        tread::run::set_commands(commands, scene_, phase_, rolling_radii_, tread::run::latest_end(scene_, phase_));
        rigid_.command(commands);
    }

    void step(double local_damping)
    {
        rigid_.find_pairs(substeps_ * dt_);
        rigid_.run(dt_, local_damping, substeps_);
    }

    void choose_substep()
    {
        constexpr double free_flight = 1e-4; // s
        const double     contact     = rigid_.shortest_contact();
        dt_                          = contact > 0 ? share_of_contact * contact : free_flight;
    }

    Exec                     exec_;
    const scene::Scene&      scene_;
    solver::DemSolver<Exec>  rigid_;
    tread::run::RunningPhase phase_;
    std::vector<double>      rolling_radii_;
    int                      substeps_;
    double                   dt_ = 0;
};

template<class Exec>
void run_on(const Exec& exec, const DemCase& what, const scene::Scene& scene, const world::World& world)
{
    const auto       count = static_cast<double>(world.bodies.size());
    DemBench<Exec>   bench(exec, scene, world, what.substeps);
    const auto       settled  = bench.settle(what.settle);
    constexpr double stirring = 0.05; // s
    if (what.state == BedState::stirred) { bench.stir(stirring); }
    const auto          searches = bench.searches();
    std::vector<double> times(3);
    for (double& time : times) { time = bench.time_substeps(what.steps); }
    const double steps_a_search =
        3.0 * what.steps / std::max<double>(1, static_cast<double>(bench.searches() - searches));
    std::sort(times.begin(), times.end());
    const solver::ContactCount contacts = bench.contacts();
    std::cout << fmt::format("{:.0f} bodies, settled in {:.2f} s to {:.1e} of their weight, a body: {:.2f} pairs, "
                             "{:.2f} touch, {:.2f} nodes; "
                             "substep {:.2e} s: {:.1f} us, "
                             "{:.1f}e6 body-steps/s, {:.0f} bytes a body, {:.1f} steps a search\n",
                             count, settled.time, settled.out_of_balance, contacts.listed / count,
                             contacts.live / count, contacts.nodes / count, bench.substep(), 1e6 * times[1],
                             1e-6 * count / times[1], static_cast<double>(exec.counters->peak_bytes()) / count,
                             steps_a_search);
    bench.print_parts(what.steps, count);
    std::cout << std::flush;
}

} // namespace

void run_dem(const DemCase& what)
{
    const scene::Scene scene = scene::load_scene(what.scene, what.overrides);
    const world::World world = world::build_world(scene);
    on_backend(what.backend, [&](const auto& exec) { run_on(exec, what, scene, world); });
}

} // namespace tread::bench
