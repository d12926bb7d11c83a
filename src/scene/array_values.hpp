#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "scene/values.hpp"

// Arrays of values: element by element.
namespace tread::scene
{

/// Applies `read` to each element; an error names the element's index.
template<class Read>
auto read_each(const NodeArray& array, const Read& read)
{
    std::vector<std::decay_t<decltype(read(array.front()))>> values;
    for (std::size_t i = 0; i < array.size(); ++i)
    {
        try
        {
            values.push_back(read(array[i]));
        }
        catch (const BadValue& bad)
        {
            throw BadValue{fmt::format("element {}: {}", i, bad.what)};
        }
    }
    return values;
}

template<class T, class Write>
std::string write_array(const T& values, const Write& write)
{
    std::string text;
    for (const auto& value : values) { text += (text.empty() ? "" : ", ") + write(value); }
    return fmt::format("[{}]", text);
}

} // namespace tread::scene
