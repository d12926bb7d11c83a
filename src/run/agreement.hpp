#pragma once

#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "run/run_scene.hpp"
#include "scene/scene.hpp"

// Several ranks compute one problem: that they are about to is found out before anything is computed or written.
namespace tread::run
{

/// Something that all ranks must have in common.
struct Fact
{
    std::string name;
    std::string value;
};

/// Collective: load_scene on every rank. Where it fails on some ranks alone, the error names one of them and its host.
scene::Scene load_on_every_rank(const Communicator& communicator, const std::string& path,
                                const std::vector<std::string>& overrides);

/// What this rank is about to run, besides the scene: program, backend, options that decide what ranks do together,
/// size and checksum of every file that the scene names. EnvironmentError when one of these cannot be read.
std::vector<Fact> facts_of_run(const scene::Scene& scene, const RunOptions& options, const std::string& backend);

/// Collective. EnvironmentError when a rank's scene, as resolved_toml writes it, or facts are not those of rank 0: it
/// names every such rank with its host, and what it has and rank 0 has not. Facts go by their place in the list.
void require_agreement(const Communicator& communicator, const std::string& scene, const std::vector<Fact>& facts);

} // namespace tread::run
