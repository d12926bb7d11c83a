#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mpi_calls.hpp"
#include "mpi_session.hpp"
#include "run/driver.hpp"
#include "scene_parts.hpp"
#include "scene_text.hpp"
#include "solver/plan.hpp"

// Parts that a whole run leaves out, with and without output.
namespace
{

using namespace tread;
using namespace tread::run;
using namespace tread::test;

struct RunUse
{
    Part  part;
    Names calls; ///< of MPI
    Names files; ///< of the run directory, after the run
    Names stages_left_out;
};

Names names_in(const std::string& directory)
{
    Names names;
    for (const auto& entry : std::filesystem::directory_iterator(directory))
    {
        names.insert(entry.path().filename().string());
    }
    return names;
}

RunUse use_of_run(const std::string& text, const std::vector<std::string>& overrides)
{
    const scene::Scene       scene = load_text(text, overrides);
    world::World             world = world::build_world(scene);
    const solver::Plan       plan  = solver::make_plan(scene, world);
    const TemporaryDirectory folder;
    Counters                 counters;
    Log                      log(test::world(), Terminal::silent);
    mpi_calls() = {};
    {
        const auto directory =
            io::RunDirectory::create(test::world(), {folder.path("run"), io::Existing::refuse, "# a scene\n", {}});
        solver::Simulation<Cpu, float> simulation(Cpu{&counters}, scene, world, plan);
        Driver<Cpu, float>             driver(test::world(), log, scene, world, directory, plan, simulation,
                                              drive_rooms(scene, world), {});
        EXPECT_FALSE(driver.run());
    }
    RunUse use{used_of(counters), mpi_calls(), names_in(folder.path("run")), {}};
    for (const solver::Stage& stage : solver::stages(scene, plan, 1))
    {
        if (!stage.on) { use.stages_left_out.insert(stage.name); }
    }
    return use;
}

/// Additions of snapshots of granular sand: the copy from which they are written.
const Part snapshots = {{"snapshot id", "snapshot material", "snapshot plastic rate", "snapshot plastic shear",
                         "snapshot position", "snapshot start", "snapshot stress", "snapshot velocity",
                         "snapshot volume ratio"},
                        {}};

const std::string no_rows = "output.every=1e9", no_checkpoints = "checkpoint.every_wall=0";

TEST(LeftOut, CallsOfMpiAreSeen)
{
    mpi_calls() = {};
    const Communicator another(MPI_COMM_SELF);
    expect_equal(mpi_calls(), {"MPI_Comm_dup"}, "MPI call");
}

/// The first and the last row are always recorded, because the balances need them. Nothing else is measured, copied or
/// written.
TEST(LeftOut, ARunWithoutOutput)
{
    const RunUse use = use_of_run(sand_text, {no_rows, no_checkpoints, "phase.rest.duration=0.01"});
    expect_equal(use.part, soil);
    expect_equal(use.calls, {}, "MPI call");
    expect_equal(use.files, {"scene.toml", "timeseries.h5", ".lock", "checkpoints"}, "file");
    EXPECT_TRUE(use.stages_left_out.count(solver::stage::snapshots));
}

TEST(LeftOut, ARunWithSnapshots)
{
    const RunUse use =
        use_of_run(sand_text, {no_rows, no_checkpoints, "phase.rest.duration=0.01", "output.snapshots_every=0.005"});
    expect_equal(use.part, soil + snapshots);
    expect_equal(use.calls, {}, "MPI call");
    EXPECT_TRUE(use.files.count("snapshots"));
    EXPECT_FALSE(use.stages_left_out.count(solver::stage::snapshots));
}

} // namespace
