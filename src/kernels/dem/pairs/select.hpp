#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/sort.hpp"

// Ordered lists of the indices that satisfy a predicate. Include after a backend's for_each.
namespace tread::dem
{
namespace select_steps
{

template<class Is>
struct Mark
{
    Is            is;
    std::int64_t  count;
    std::int32_t* place; ///< [count + 1]

    TREAD_HD void operator()(std::int64_t i) const { place[i] = i < count && is(i) ? 1 : 0; }
};

struct Write
{
    const std::int32_t* place; ///< [count + 1], after the scan
    std::int32_t*       list;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (place[i] != place[i + 1]) { list[place[i]] = static_cast<std::int32_t>(i); }
    }
};

} // namespace select_steps

/// Fills `list` with the i in [0, count) for which is(i) holds, ascending; `place` is scratch.
template<class Exec, class Is>
void select(const Exec& exec, const char* name, std::int64_t count, const Is& is, Array<Exec, std::int32_t>& place,
            SortScratch<Exec>& scratch, Array<Exec, std::int32_t>& list)
{
    place.resize(count + 1);
    for_each(exec, name, count + 1, select_steps::Mark<Is>{is, count, place.data()});
    list.resize(exclusive_scan(exec, place, scratch));
    if (list.size() > 0) { for_each(exec, name, count, select_steps::Write{place.data(), list.data()}); }
}

} // namespace tread::dem
