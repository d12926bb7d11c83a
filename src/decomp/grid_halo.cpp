#include "decomp/grid_halo.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "backend/instantiate.hpp"
#include "kernels/mpm/grid/wall_kern.hpp"

namespace tread::decomp
{
namespace
{

/// Index of each of `pages` in `all`, which contains all of them.
std::vector<std::int32_t> places_in(const PageKeys& all, const PageKeys& pages)
{
    std::vector<std::int32_t> places;
    places.reserve(pages.size());
    for (const std::uint64_t page : pages)
    {
        places.push_back(static_cast<std::int32_t>(std::lower_bound(all.begin(), all.end(), page) - all.begin()));
    }
    return places;
}

/// Inverse of `places`: for each of `count` pages its index in `places`, or -1.
std::vector<std::int32_t> numbers_of(const std::vector<std::int32_t>& places, std::size_t count)
{
    std::vector<std::int32_t> numbers(count, -1);
    std::int32_t              number = 0;
    for (const std::int32_t place : places) { numbers[static_cast<std::size_t>(place)] = number++; }
    return numbers;
}

std::vector<std::int32_t> picked(const std::vector<std::int32_t>& places, const std::vector<std::int32_t>& numbers)
{
    std::vector<std::int32_t> out;
    out.reserve(numbers.size());
    for (const std::int32_t number : numbers) { out.push_back(places[static_cast<std::size_t>(number)]); }
    return out;
}

} // namespace

template<class Exec, class Real>
GridHalo<Exec, Real>::GridHalo(Decomposition<Exec>& decomposition)
    : decomposition_(decomposition)
    , stream_(decomposition.transport.exec())
    , shared_(decomposition.transport.exec())
    , border_(decomposition.transport.exec(), "border pages")
    , interior_(decomposition.transport.exec(), "interior pages")
    , exchange_(decomposition.transport, stream_.exec(), "grid halo messages")
{
}

template<class Exec, class Real>
void GridHalo<Exec, Real>::plan(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls)
{
    const Exec& exec    = decomposition_.transport.exec();
    PageKeys    listed  = pages.node_page_key.to_host();
    const auto  is_held = [&](std::uint64_t page) { return mpm::has_held_nodes(walls, mpm::page_coordinates(page)); };
    const auto  reached = pages_nearby(decomposition_.communicator, listed);
    HaloPlan    halo    = plan_halo(decomposition_.rank(), reached, is_held);
    if (!halo.extra.empty())
    {
        PageKeys all;
        std::merge(listed.begin(), listed.end(), halo.extra.begin(), halo.extra.end(), std::back_inserter(all));
        mpm::set_node_pages(exec, pages, all);
        listed = std::move(all);
    }

    const std::vector<std::int32_t> places  = places_in(listed, halo.shared);
    const std::vector<std::int32_t> numbers = numbers_of(places, listed.size());
    list_border(pages, numbers);
    shared_.page.assign(places);
    shared_.number_of.assign(numbers);
    shared_.first_part.assign(halo.first_part);
    shared_.part.assign(halo.part);
    shared_.tallied_elsewhere.assign(picked(places, halo.tallied_elsewhere));

    std::vector<std::int32_t> rows;
    std::vector<Route>        to, from;
    for (std::size_t rank = 0; rank < halo.send.size(); ++rank)
    {
        const auto& send = halo.send[rank];
        rows.insert(rows.end(), send.begin(), send.end());
        if (!send.empty()) { to.push_back({static_cast<int>(rank), static_cast<std::int64_t>(send.size())}); }
        if (halo.arrivals[rank] > 0) { from.push_back({static_cast<int>(rank), halo.arrivals[rank]}); }
    }
    exchange_.plan(rows, std::move(to), std::move(from));
    const std::int64_t count = shared_.page.size();
    shared_.own.resize(count * mpm::node_page_values);
    shared_.total.resize(count * mpm::node_page_values);
}

template<class Exec, class Real>
void GridHalo<Exec, Real>::resume(mpm::Pages<Exec>& pages, const mpm::GridWalls& walls)
{
    const PageKeys    listed = pages.node_page_key.to_host();
    std::vector<bool> is_reached(listed.size(), false);
    for (const std::int32_t page : pages.node_page_of.to_host()) { is_reached[static_cast<std::size_t>(page)] = true; }
    PageKeys reached;
    for (std::size_t page = 0; page < listed.size(); ++page)
    {
        if (is_reached[page]) { reached.push_back(listed[page]); }
    }
    if (reached.size() < listed.size()) { mpm::set_node_pages(decomposition_.transport.exec(), pages, reached); }
    plan(pages, walls);
}

/// Uses all pages with a tile: points may reach one that is empty now before pages are rebuilt.
template<class Exec, class Real>
void GridHalo<Exec, Real>::list_border(const mpm::Pages<Exec>& pages, const std::vector<std::int32_t>& shared_number)
{
    const std::vector<std::int32_t> reached = pages.node_page_of.to_host();
    std::vector<std::int32_t>       border, interior;
    for (std::size_t first = 0; first < reached.size(); first += mpm::octants)
    {
        bool shared = false;
        for (std::size_t i = first; i < first + mpm::octants; ++i)
        {
            shared = shared || shared_number[static_cast<std::size_t>(reached[i])] >= 0;
        }
        (shared ? border : interior).push_back(static_cast<std::int32_t>(first / mpm::octants));
    }
    border_.assign(border);
    interior_.assign(interior);
}

template<class Exec, class Real>
void GridHalo<Exec, Real>::send(const mpm::PagesView& pages, const Real* tiles)
{
    mpm::sum_own_parts(stream_.exec(), pages, tiles, shared_);
    Columns columns;
    columns.add(rows(shared_.own.data(), mpm::node_page_values));
    exchange_.begin(columns);
}

template<class Exec, class Real>
void GridHalo<Exec, Real>::finish()
{
    const auto* arrived = reinterpret_cast<const Real*>(exchange_.finish());
    mpm::add_parts(stream_.exec(), arrived, shared_);
    stream_.join();
}

template<class Exec, class Real>
void GridHalo<Exec, Real>::clear_tallied_elsewhere(int width, double* tallies)
{
    mpm::clear_tallied_elsewhere(decomposition_.transport.exec(), shared_, width, tallies);
}

#define TREAD_INSTANTIATE(Exec, Real) template class GridHalo<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
