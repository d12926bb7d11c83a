#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tread::scene
{

/// Reads, completes and checks the scene of a TOML file (keys, units and ranges: docs/scene.md).
///
/// Each override is `a.b=c`, as in `--set`: "domain.gravity=[0, 0, -9.8]", "material.sand.young=1e6" or
/// "material[0].young=1e6" (elements of arrays of tables are addressed by name or index). The value is TOML; a bare
/// word is a string.
///
/// The result is complete: families, every pair of contacts that can occur, absolute mesh paths. Throws InputError with
/// every problem found, one per line: `file:line: [table] key: what; accepted: range`.
Scene load_scene(const std::string& path, const std::vector<std::string>& overrides);

/// A scene that is not in a file.
struct SceneText
{
    std::string text;      ///< TOML
    std::string name;      ///< stands in messages for the file
    std::string directory; ///< base of relative file names
};

/// The same of a text.
Scene load_scene(const SceneText& source, const std::vector<std::string>& overrides);

} // namespace tread::scene
