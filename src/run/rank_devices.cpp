#include "run/rank_devices.hpp"

#ifdef TREAD_WITH_CUDA
#include <set>

#include <fmt/format.h>

#include "backend/device.hpp"

namespace tread::run
{
int device_of_rank(const Communicator& communicator, GpuSharing sharing)
{
    const int                      device = communicator.local_rank() % device_count();
    const std::vector<std::string> chips  = communicator.gather(host_name() + device_facts(device).identity);
    const std::set<std::string>    used(chips.begin(), chips.end());
    if (used.size() < chips.size() && sharing == GpuSharing::refused)
    {
        throw EnvironmentError(fmt::format("{} ranks, but {} GPUs: start one rank a GPU, or take --share-gpus",
                                           chips.size(), used.size()));
    }
    return device;
}

std::vector<std::string> log_devices(const Communicator& communicator, Log& log, int device)
{
    const std::string        name = device_facts(device).name;
    std::vector<std::string> names;
    std::int32_t             rank = 0;
    for (const std::string& line : communicator.gather(fmt::format("{}\n{}\n{}", host_name(), device, name)))
    {
        const std::size_t first = line.find('\n'), second = line.find('\n', first + 1);
        names.push_back(line.substr(second + 1));
        if (communicator.size() > 1)
        {
            log.info(fmt::format("rank {}: host {}, device {}, {}", rank, line.substr(0, first),
                                 line.substr(first + 1, second - first - 1), names.back()));
        }
        ++rank;
    }
    return names;
}

} // namespace tread::run
#endif
