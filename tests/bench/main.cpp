#include <iostream>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "base/communicator.hpp"
#include "dem.hpp"
#include "messages.hpp"
#include "mpm.hpp"
#include "scene.hpp"

// Benchmarks: they print figures and check none.
namespace
{

using namespace tread;

template<class T>
void add_word(CLI::App& command, const std::string& name, T& value, const std::map<std::string, T>& words)
{
    command.add_option(name, value)->transform(CLI::CheckedTransformer(words))->type_name("WORD");
}

void add_backend(CLI::App& command, Backend& backend)
{
    add_word<Backend>(command, "--backend", backend, {{"cpu", Backend::cpu}, {"cuda", Backend::cuda}});
}

void add_transport(CLI::App& command, decomp::TransportChoice& transport)
{
    add_word<decomp::TransportChoice>(command, "--transport", transport,
                                      {{"auto", decomp::TransportChoice::automatic},
                                       {"mpi", decomp::TransportChoice::mpi},
                                       {"nccl", decomp::TransportChoice::nccl},
                                       {"host", decomp::TransportChoice::host}});
}

template<class Case>
void add_scene(CLI::App& command, Case& what)
{
    command.add_option("SCENE", what.scene, "TOML file")->required();
    command.add_option("--set", what.overrides, "a.b=c, as of tread run")->expected(1)->take_all();
}

void add_mpm_options(CLI::App& command, bench::MpmCase& mpm, double& points)
{
    command.add_option("--points", points, "About how many, as 1e6; with --mode weak of each rank");
    command.add_option("--per-cell", mpm.per_cell, "1, 8, 27 or 64");
    command.add_option("--steps", mpm.steps, "Timed steps, three times");
    add_word<scene::MaterialModel>(command, "--law", mpm.law,
                                   {{"elastic", scene::MaterialModel::elastic},
                                    {"mohr-coulomb", scene::MaterialModel::mohr_coulomb},
                                    {"drucker-prager", scene::MaterialModel::drucker_prager},
                                    {"drucker-prager-cap", scene::MaterialModel::drucker_prager_cap},
                                    {"bolton", scene::MaterialModel::bolton}});
    add_word<bench::SandState>(command, "--state", mpm.state,
                               {{"settled", bench::SandState::settled}, {"collapsing", bench::SandState::collapsing}});
    add_word<scene::Transfer>(
        command, "--transfer", mpm.transfer,
        {{"flip", scene::Transfer::flip}, {"apic", scene::Transfer::apic}, {"aflip", scene::Transfer::aflip}});
    add_word<scene::Precision>(command, "--precision", mpm.precision,
                               {{"single", scene::Precision::single_}, {"double", scene::Precision::double_}});
    add_backend(command, mpm.backend);
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App                app("tread-bench: what a step costs", "tread-bench");
    bench::MpmCase          mpm;
    double                  points          = 1e6;
    CLI::App*               mpm_command     = app.add_subcommand("mpm", "Whole steps of pure sand");
    CLI::App*               scaling_command = app.add_subcommand("scaling", "The same on the ranks of mpirun");
    bench::Scaling          scaling         = bench::Scaling::weak;
    decomp::TransportChoice transport       = decomp::TransportChoice::automatic;
    add_word<bench::Scaling>(*scaling_command, "--mode", scaling,
                             {{"weak", bench::Scaling::weak}, {"strong", bench::Scaling::strong}});
    add_transport(*scaling_command, transport);
    for (CLI::App* command : {mpm_command, scaling_command}) { add_mpm_options(*command, mpm, points); }
    bench::DemCase dem;
    CLI::App*      dem_command = app.add_subcommand("dem", "Substeps of a scene's bodies");
    add_scene(*dem_command, dem);
    dem_command->add_option("--settle", dem.settle, "s, at most, to equilibrium before anything is timed");
    dem_command->add_option("--substeps", dem.substeps, "Between two searches for pairs");
    dem_command->add_option("--steps", dem.steps, "Timed steps of so many substeps, three times");
    add_word<bench::BedState>(*dem_command, "--state", dem.state,
                              {{"settled", bench::BedState::settled}, {"stirred", bench::BedState::stirred}});
    add_backend(*dem_command, dem.backend);
    bench::SceneCase scene;
    CLI::App*        scene_command = app.add_subcommand("scene", "Steps of a scene on the ranks of mpirun");
    add_scene(*scene_command, scene);
    scene_command->add_option("--settle", scene.settle, "Steps before anything is timed");
    scene_command->add_option("--steps", scene.steps, "Timed steps, three times");
    add_transport(*scene_command, scene.transport);
    add_backend(*scene_command, scene.backend);
    bench::MessagesCase messages;
    CLI::App*           messages_command = app.add_subcommand("messages", "Messages between ranks that share a wheel");
    messages_command->add_option("--rounds", messages.rounds, "Timed rounds, three times");
    add_transport(*messages_command, messages.transport);
    add_backend(*messages_command, messages.backend);
    app.require_subcommand(1);
    CLI11_PARSE(app, argc, argv);
    mpm.points = static_cast<std::int64_t>(points);
    try
    {
        if (dem_command->parsed()) { bench::run_dem(dem); }
        else if (scaling_command->parsed())
        {
            const MpiSession session;
            bench::run_scaling(session.world(), mpm, scaling, transport);
        }
        else if (scene_command->parsed())
        {
            const MpiSession session;
            bench::run_scene(session.world(), scene);
        }
        else if (messages_command->parsed())
        {
            const MpiSession session;
            bench::run_messages(session.world(), messages);
        }
        else { bench::run_mpm(mpm); }
    }
    catch (const std::exception& error)
    {
        std::cerr << "tread-bench: error: " << error.what() << std::endl;
        return 4;
    }
    return 0;
}
