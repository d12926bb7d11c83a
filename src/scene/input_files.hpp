#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tread::scene
{

/// A file named by a scene.
struct InputFile
{
    std::string path; ///< absolute
    std::string key;  ///< "[[rocks]] 0 from"
};

/// Lists meshes, heights, settled beds and reference values of a loaded scene, in the order of its tables.
std::vector<InputFile> input_files(const Scene& scene);

} // namespace tread::scene
