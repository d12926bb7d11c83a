#pragma once

#include <string>

#include "scene/scene.hpp"

namespace tread::scene
{

/// Writes the scene as TOML with every key explicit and every number in its shortest form that reads back the same.
/// load_scene of it gives the same scene (except `directory`) from any directory.
std::string resolved_toml(const Scene& scene);

/// 64-bit FNV-1a hash of the resolved scene without its title and keys that no run reads, as 16 hexadecimal digits;
/// equal for equal runs.
std::string scene_hash(const Scene& scene);

} // namespace tread::scene
