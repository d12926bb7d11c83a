#pragma once

#include <string>

#include "base/errors.hpp"
#include "scene/scene.hpp"

namespace tread::scene
{

/// "sand.toml:41: ", where a table of a list was written, by its name in messages ("rocks[0]", "body.wheel"); empty
/// where that is not known: a built-in shape, a scene that was not read from a file.
std::string line_of(const Scene& scene, const std::string& table);

/// What `act` gives. An InputError or EnvironmentError of it says also where the table was written.
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
