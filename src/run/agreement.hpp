#pragma once

#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "run/run_scene.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"

// Checks, before anything is computed or written, that all ranks are about to compute the same problem.
namespace tread::run
{

/// A name and value that must agree on all ranks.
struct Fact
{
    std::string name;
    std::string value;
};

/// Collective: calls load_scene on every rank. If it fails on some ranks only, the error names one of them and its
/// host.
scene::Scene load_on_every_rank(const Communicator& communicator, const std::string& path,
                                const std::vector<std::string>& overrides);
scene::Scene load_on_every_rank(const Communicator& communicator, const scene::SceneText& source,
                                const std::vector<std::string>& overrides);

/// Lists what this rank is about to run, besides the scene: program, backend, options that decide what ranks do
/// together, size and checksum of every file that the scene names. EnvironmentError when one of these cannot be read.
std::vector<Fact> facts_of_run(const scene::Scene& scene, const RunOptions& options, const std::string& backend);

/// Collective. Throws EnvironmentError when a rank's scene, as resolved_toml writes it, or its facts differ from rank
/// 0's: the message names every such rank with its host and the differences. Facts are compared by index.
void require_agreement(const Communicator& communicator, const std::string& scene, const std::vector<Fact>& facts);

} // namespace tread::run
