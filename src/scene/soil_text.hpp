#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tread::scene
{

/// What `tread soils` prints: each soil with its constants, units and sources.
std::string soils_text();

/// The same as Markdown: what docs/soils.md holds below `soils_heading`.
std::string soils_markdown();

inline constexpr const char* soils_heading = "## Soils\n";

/// Lines that say what the scene's materials took from soils, one for each value.
std::vector<std::string> soil_lines(const Scene& scene);

} // namespace tread::scene
