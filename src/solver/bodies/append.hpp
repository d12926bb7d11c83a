#pragma once

#include <cstddef>
#include <vector>

namespace tread::solver
{

/// Appends `from` to `to`; returns where it starts.
template<class T>
std::size_t append(std::vector<T>& to, const std::vector<T>& from)
{
    const std::size_t start = to.size();
    to.insert(to.end(), from.begin(), from.end());
    return start;
}

} // namespace tread::solver
