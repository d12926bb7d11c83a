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
    std::vector<std::string> overrides;       ///< as of --set
    int                      settle    = 100; ///< steps before anything is timed
    int                      steps     = 100; ///< timed, three times
    decomp::TransportChoice  transport = decomp::TransportChoice::automatic;
    Backend                  backend   = Backend::cpu;
};

/// Times whole steps of a scene in its first phase on all ranks of the communicator, then each stage by itself; prints
/// points a second, substeps, the balance, and of each stage the time of the quickest and of the slowest rank.
void run_scene(const Communicator& communicator, const SceneCase& what);

} // namespace tread::bench
