#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tread::scene
{

/// A file that a scene names.
struct InputFile
{
    std::string path; ///< absolute
    std::string key;  ///< "[[rocks]] 0 from"
};

/// Meshes, heights, settled beds and reference values of a loaded scene, in the order of its tables.
std::vector<InputFile> input_files(const Scene& scene);

} // namespace tread::scene
