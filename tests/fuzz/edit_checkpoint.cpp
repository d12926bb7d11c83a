#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>
#include <omp.h>

#include "base/communicator.hpp"
#include "base/errors.hpp"
#include "base/log.hpp"
#include "edited_file.hpp"
#include "io/checksum.hpp"
#include "io/h5.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/drive_room.hpp"
#include "run/driver.hpp"
#include "run/restart.hpp"
#include "scene/load.hpp"
#include "scene/resolved.hpp"
#include "scratch_file.hpp"
#include "world/world.hpp"

// Goes on from a checkpoint with changed values, rows and attributes, to the end of the run: the result must be a
// finished run or one of tread's errors.
namespace
{

using namespace tread;

constexpr std::size_t  scenes     = 3;
constexpr std::int64_t head_bytes = 512;

/// A scene as built, which takes most of a restart's time: once for all executions.
struct Built
{
    explicit Built(const std::string& file)
        : scene(scene::load_scene(file, {}))
        , world(world::build_world(scene))
        , plan(solver::make_plan(scene, world, 1))
        , rooms(run::drive_rooms(scene, world))
    {
    }

    scene::Scene                scene;
    world::World                world;
    solver::Plan                plan;
    std::vector<run::DriveRoom> rooms;
};

std::unique_ptr<Communicator>              alone;
std::array<std::unique_ptr<Built>, scenes> built;

/// Makes the head of a checkpoint right for what it holds (src/io/checkpoint_file.cpp).
void seal(const std::string& path)
{
    const auto  bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
    std::string head  = fmt::format("tread checkpoint\nbytes {}\nchecksum {:016x}\n", bytes,
                                    io::checksum(*alone, path, head_bytes, bytes));
    head.resize(static_cast<std::size_t>(head_bytes), '\0');
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).write(head.data(), head_bytes);
}

/// Runs from the plan of the restart to the last step, as run_scene does.
void go_on(const Built& from, const std::string& checkpoint)
{
    const std::string output = checkpoint + ".run";
    try
    {
        Log                    log(*alone, Terminal::silent);
        const run::RestartPlan restart =
            run::plan_restart(*alone, from.scene, {run::RestartMode::file, checkpoint}, output, io::Existing::refuse);
        const auto directory =
            io::RunDirectory::create(*alone, {output, restart.existing, scene::resolved_toml(from.scene), {}});
        Counters                       counters;
        const Cpu                      cpu{&counters};
        world::World                   world = from.world; // the driver releases its rocks
        solver::Simulation<Cpu, float> simulation(cpu, from.scene, world, from.plan, nullptr);
        run::DriverOptions             options;
        options.checkpoint     = restart.checkpoint;
        options.wall_start     = run::wall_clock();
        options.walltime_limit = 2; // time and steps of a changed file may be those of a long run
        run::Driver<Cpu, float> driver(*alone, log, from.scene, world, directory, from.plan, simulation, from.rooms,
                                       options);
        driver.run();
    }
    catch (const Error&)
    {
    }
    std::filesystem::remove_all(output);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    omp_set_num_threads(1); // the fuzzer runs a process a core
    io::h5::begin();
    MPI_Init(argc, argv);
    alone = std::make_unique<Communicator>(MPI_COMM_WORLD);
    for (std::size_t i = 0; i < scenes; ++i)
    {
        built[i] = std::make_unique<Built>(fmt::format("{}/{}.toml", fuzz::originals(), i));
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const fuzz::ScratchFile file(".h5");
    if (size == 0) { return 0; }
    const std::size_t which = data[0] % scenes;
    fuzz::write_edited(fmt::format("{}/{}.h5", fuzz::originals(), which), file.path(), data + 1, size - 1,
                       "run/timeseries");
    seal(file.path());
    go_on(*built[which], file.path());
    return 0;
}
