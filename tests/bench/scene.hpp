#pragma once

#include <string>
#include <vector>

#include "backend_choice.hpp"
#include "base/communicator.hpp"
#include "decomp/transport.hpp"

namespace tread::bench
{

struct SceneCase
{
    std::string              scene;           ///< TOML file
    std::vector<std::string> overrides;       ///< as in --set
    int                      settle    = 100; ///< steps before the timing starts
    int                      steps     = 100; ///< timed, three times
    decomp::TransportChoice  transport = decomp::TransportChoice::automatic;
    Backend                  backend   = Backend::cpu;
};

/// Times whole steps of a scene in its first phase on all ranks of the communicator, then each stage by itself. Prints
/// points per second, substeps, the balance, and for each stage the time of the fastest and slowest rank.
void run_scene(const Communicator& communicator, const SceneCase& what);

} // namespace tread::bench
