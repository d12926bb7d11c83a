#pragma once

#include <string>
#include <vector>

#include "backend_choice.hpp"

namespace tread::bench
{

enum class BedState
{
    settled,
    stirred ///< by what the scene's second phase drives
};

struct DemCase
{
    std::string              scene;         ///< TOML file; only its bodies count
    std::vector<std::string> overrides;     ///< as of --set
    double                   settle   = 2;  ///< s, at most, with local damping, before anything is timed
    int                      substeps = 20; ///< between two searches for pairs
    int                      steps    = 16; ///< of so many substeps, timed three times
    BedState                 state    = BedState::settled;
    Backend                  backend  = Backend::cpu;
};

/// Times the bodies of a scene, settled first: substeps with their share of the search for pairs, and each part;
/// prints body-steps a second, live contacts and bytes a body.
void run_dem(const DemCase& what);

} // namespace tread::bench
