#include "scene/lines.hpp"

namespace tread::scene
{

std::string line_of(const Scene& scene, const std::string& table)
{
    const auto found = scene.lines.of.find(table);
    return found == scene.lines.of.end() ? "" : found->second + ": ";
}

} // namespace tread::scene
