#include "solver/sand/page_bounds.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "backend/sort.hpp"
#include "kernels/mpm/transfers/tile_kern.hpp"

namespace tread::solver
{
namespace
{

using accept::Refusal;
using accept::Verdict;

constexpr std::uint64_t key_end = std::uint64_t{1} << 57; ///< keys are Morton codes of 57 bits

/// Index of a page in ascending keys, or -1.
std::int32_t place_of(const std::vector<std::uint64_t>& keys, mpm::Index3 page)
{
    return static_cast<std::int32_t>(
        find_sorted(keys.data(), static_cast<std::int64_t>(keys.size()), mpm::page_key(page)));
}

/// Accepts a table of `width` indices per key, each equal to expected(key, column).
template<class Expected>
Verdict table(const std::vector<std::int32_t>& values, const std::vector<std::uint64_t>& keys, std::size_t width,
              const Expected& expected)
{
    if (auto refusal = accept::rows(width * keys.size())(values)) { return refusal; }
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        const std::int32_t wanted = expected(keys[i / width], i % width);
        if (values[i] == wanted) { continue; }
        return Refusal{static_cast<std::int64_t>(i), fmt::format("{}", values[i]),
                       fmt::format("{}, as the keys of the pages have it", wanted)};
    }
    return {};
}

} // namespace

Verdict PageBounds::keys(const std::string& name, const std::vector<std::uint64_t>& values)
{
    const auto is_key = [](std::uint64_t key) { return key < key_end; };
    const auto bound  = accept::all(accept::ascending(), accept::distinct(), accept::each("a key of 57 bits", is_key));
    if (auto refusal = bound(values)) { return refusal; }
    if (name == "point_page_key") { point_page_key_ = values; }
    else if (name == "node_page_key") { node_page_key_ = values; }
    else { return Refusal{-1, "a table of keys", "one that this program knows"}; }
    return {};
}

/// Checks the place of each listed point's cell in its page.
Verdict PageBounds::places(const std::string& name, const std::vector<std::uint8_t>& values) const
{
    if (name != "place_at") { return Refusal{-1, "a table of bytes", "one that this program knows"}; }
    if (auto refusal = accept::rows(static_cast<std::size_t>(points_))(values)) { return refusal; }
    for (std::size_t c = 0; c + 1 < cell_first_point_.size(); ++c)
    {
        const std::size_t place = c % mpm::page_cells;
        for (auto i = static_cast<std::size_t>(cell_first_point_[c]);
             i < static_cast<std::size_t>(cell_first_point_[c + 1]); ++i)
        {
            if (values[i] == place) { continue; }
            return Refusal{static_cast<std::int64_t>(i), fmt::format("{}", values[i]),
                           fmt::format("{}, as cell_first_point has it", place)};
        }
    }
    return {};
}

Verdict PageBounds::numbers(const std::string& name, const std::vector<std::int32_t>& values)
{
    const std::size_t pages = point_page_key_.size();
    if (name == "first_point")
    {
        first_point_ = values;
        return accept::offsets(pages, points_)(values);
    }
    if (name == "cell_first_point")
    {
        cell_first_point_ = values;
        return cells(values);
    }
    if (name == "point_at") { return accept::permutation(static_cast<std::size_t>(points_))(values); }
    if (name == "neighbour") { return neighbours(values); }
    if (name == "node_page_of") { return node_pages(values); }
    if (name == "point_page_of") { return point_pages(values); }
    return Refusal{-1, "a table of numbers", "one that this program knows"};
}

/// The first cell of a page must begin where its points do.
Verdict PageBounds::cells(const std::vector<std::int32_t>& values) const
{
    const std::size_t pages = point_page_key_.size();
    if (auto refusal = accept::offsets(mpm::page_cells * pages, points_)(values)) { return refusal; }
    for (std::size_t page = 0; page < pages; ++page)
    {
        const std::size_t first = mpm::page_cells * page;
        if (values[first] == first_point_[page]) { continue; }
        return Refusal{static_cast<std::int64_t>(first), fmt::format("{}", values[first]),
                       fmt::format("{}, as first_point has it", first_point_[page])};
    }
    return {};
}

Verdict PageBounds::neighbours(const std::vector<std::int32_t>& values) const
{
    const auto place = [&](std::uint64_t key, std::size_t d)
    { return place_of(point_page_key_, mpm::page_towards(mpm::page_coordinates(key), static_cast<int>(d))); };
    return table(values, point_page_key_, mpm::directions, place);
}

/// Every point page must have the node pages that it reaches.
Verdict PageBounds::node_pages(const std::vector<std::int32_t>& values) const
{
    const auto place = [&](std::uint64_t key, std::size_t o)
    { return place_of(node_page_key_, mpm::page_at_octant(mpm::page_coordinates(key), static_cast<int>(o))); };
    if (auto refusal = table(values, point_page_key_, mpm::octants, place)) { return refusal; }
    return accept::index(node_page_key_.size())(values);
}

Verdict PageBounds::point_pages(const std::vector<std::int32_t>& values) const
{
    const auto place = [&](std::uint64_t key, std::size_t o)
    { return place_of(point_page_key_, mpm::page_at_octant(mpm::page_coordinates(key), static_cast<int>(o), -1)); };
    return table(values, node_page_key_, mpm::octants, place);
}

} // namespace tread::solver
