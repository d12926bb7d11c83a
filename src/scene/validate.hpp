#pragma once

#include "scene/problems.hpp"
#include "scene/scene.hpp"

namespace tread::scene
{

/// Checks across keys: names, references, mutually exclusive choices, positions in the domain. `document` is the source
/// of `scene`; problems refer to its lines.
void validate(const Scene& scene, const Node& document, Problems& problems);

/// Name of a table in messages: "domain", "material.sand", or "terrain[0]" if it has no name.
std::string table_label(const Node& document, const std::string& table, std::size_t index);

} // namespace tread::scene
