#include "scene/input_files.hpp"

#include <optional>

#include <fmt/format.h>

#include "scene/motion_tables.hpp"

namespace tread::scene
{
namespace
{

void add_height(const std::optional<Height>& height, const std::string& key, std::vector<InputFile>& files)
{
    const auto* raster = height ? std::get_if<RasterFile>(&*height) : nullptr;
    if (raster != nullptr) { files.push_back({raster->path, key + " file"}); }
}

/// Adds the files named by [[terrain]] or [[rocks]] tables.
template<class T>
void add_places(const std::vector<T>& items, const char* table, std::vector<InputFile>& files)
{
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        const std::string label = fmt::format("[[{}]] {} ", table, i);
        if (!items[i].from.empty()) { files.push_back({items[i].from, label + "from"}); }
        add_height(items[i].height, label + "height", files);
        add_height(items[i].floor, label + "floor", files);
    }
}

} // namespace

std::vector<InputFile> input_files(const Scene& scene)
{
    std::vector<InputFile> files;
    for (const Shape& shape : scene.shapes)
    {
        const auto* mesh = std::get_if<MeshFile>(&shape.source);
        if (mesh != nullptr) { files.push_back({mesh->path, fmt::format("[[shape]] '{}' file", shape.name)}); }
    }
    add_places(scene.terrain, "terrain", files);
    add_places(scene.rocks, "rocks", files);
    add_motion_files(scene, [&](const std::string& path, const std::string& key) { files.push_back({path, key}); });
    if (!scene.reference.file.empty()) { files.push_back({scene.reference.file, "[reference] file"}); }
    return files;
}

} // namespace tread::scene
