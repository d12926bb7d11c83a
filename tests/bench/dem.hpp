#pragma once

#include <string>
#include <vector>

#include "backend_choice.hpp"

namespace tread::bench
{

enum class BedState
{
    settled,
    stirred ///< driven by the scene's second phase
};

struct DemCase
{
    std::string              scene;         ///< TOML file; only its bodies are used
    std::vector<std::string> overrides;     ///< as in --set
    double                   settle   = 2;  ///< s, at most; local damping before the timing starts
    int                      substeps = 20; ///< between two pair searches
    int                      steps    = 16; ///< each of `substeps`, timed three times
    BedState                 state    = BedState::settled;
    Backend                  backend  = Backend::cpu;
};

/// Times the bodies of a scene after settling: substeps with their share of the pair search, and each part. Prints
/// body-steps per second, live contacts and bytes per body.
void run_dem(const DemCase& what);

} // namespace tread::bench
