#pragma once

#include <string>

#include "base/errors.hpp"
#include "scene/scene.hpp"

namespace tread::scene
{

/// Line of a table in the scene file, "sand.toml:41: ", by its name in messages ("rocks[0]", "body.wheel"); empty if
/// unknown, as for a built-in shape or a scene that was not read from a file.
std::string line_of(const Scene& scene, const std::string& table);

/// Returns the result of `act`; an InputError or EnvironmentError of it is extended by the table's line.
template<class Act>
decltype(auto) with_line_of(const Scene& scene, const std::string& table, const Act& act)
{
    try
    {
        return act();
    }
    catch (const InputError& error)
    {
        throw InputError(line_of(scene, table) + error.what());
    }
    catch (const EnvironmentError& error)
    {
        throw EnvironmentError(line_of(scene, table) + error.what());
    }
}

} // namespace tread::scene
