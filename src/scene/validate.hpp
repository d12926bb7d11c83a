#pragma once

#include "scene/problems.hpp"
#include "scene/scene.hpp"

namespace tread::scene
{

/// Checks what no single key can tell: names, references, choices that exclude each other, places in the domain.
/// `document` is what `scene` was read from; problems point into it.
void validate(const Scene& scene, const Node& document, Problems& problems);

/// Name of a table in messages: "domain", "material.sand", or "terrain[0]" if it has no name.
std::string table_label(const Node& document, const std::string& table, std::size_t index);

} // namespace tread::scene
