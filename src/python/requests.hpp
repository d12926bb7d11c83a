#pragma once

#include <string>

#include <mpi.h>
#include <nlohmann/json.hpp>

#include "base/communicator.hpp"
#include "run/run_scene.hpp"
#include "run/visit.hpp"
#include "scene/scene.hpp"

// JSON of the C interface: what Python asks, as the program's own types, and its answers.
namespace tread::python
{

using Json = nlohmann::ordered_json;

/// The scene of a request {"scene": {"path" or "text", "name", "directory"; "overrides"}}. Collective; errors are those
/// of load_scene.
scene::Scene scene_of(const Communicator& communicator, const Json& request);

/// Options of a run, with neither visitor nor start; `request` has all of them.
run::RunOptions options_of(const Json& request);

/// MPI's handle of the Fortran handle in a request; of all processes where it has none.
MPI_Comm communicator_of(const Json& request);

/// Answers a request of a visit.
std::string answer(run::Visit& visit, const Json& request);

} // namespace tread::python
