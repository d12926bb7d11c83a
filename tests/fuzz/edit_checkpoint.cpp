#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <mpi.h>

#include "base/communicator.hpp"
#include "base/errors.hpp"
#include "base/log.hpp"
#include "edited_file.hpp"
#include "io/checksum.hpp"
#include "io/h5.hpp"
#include "run/run_scene.hpp"
#include "scene/load.hpp"
#include "scratch_file.hpp"

// Goes on from a checkpoint with changed values, rows and attributes, to the end of the run: the result must be a
// finished run or one of tread's errors.
namespace
{

using namespace tread;

constexpr std::size_t  scenes     = 3;
constexpr std::int64_t head_bytes = 512;

std::unique_ptr<Communicator>                     world;
std::array<std::unique_ptr<scene::Scene>, scenes> scene_of;

/// Makes the head of a checkpoint right for what it holds (src/io/checkpoint_file.cpp).
void seal(const std::string& path)
{
    const auto  bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
    std::string head  = fmt::format("tread checkpoint\nbytes {}\nchecksum {:016x}\n", bytes,
                                    io::checksum(*world, path, head_bytes, bytes));
    head.resize(static_cast<std::size_t>(head_bytes), '\0');
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).write(head.data(), head_bytes);
}

void go_on(const scene::Scene& scene, const std::string& checkpoint)
{
    run::RunOptions options;
    options.output  = checkpoint + ".run";
    options.backend = run::BackendChoice::cpu;
    options.threads = 1;
    options.restart = {run::RestartMode::file, checkpoint};
    try
    {
        Log log(*world, Terminal::silent);
        run::run_scene(*world, log, nullptr, scene, options);
    }
    catch (const Error&)
    {
    }
    std::filesystem::remove_all(options.output);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    io::h5::begin();
    MPI_Init(argc, argv);
    world = std::make_unique<Communicator>(MPI_COMM_WORLD);
    for (std::size_t i = 0; i < scenes; ++i)
    {
        scene_of[i] =
            std::make_unique<scene::Scene>(scene::load_scene(fmt::format("{}/{}.toml", fuzz::originals(), i), {}));
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
    go_on(*scene_of[which], file.path());
    return 0;
}
