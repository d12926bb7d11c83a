#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

// Look-up of a scene's tables by their names.
namespace tread::scene
{

/// Index of the first item called `name`; the number of items if there is none.
template<class T>
std::size_t index_of(const std::vector<T>& items, const std::string& name)
{
    const auto at = std::find_if(items.begin(), items.end(), [&](const T& item) { return item.name == name; });
    return static_cast<std::size_t>(at - items.begin());
}

/// Whether a list of names has this one.
inline bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace tread::scene
