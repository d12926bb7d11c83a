#pragma once

#include "kernels/mpm/pages/pages.hpp"
#include "world/sand.hpp"

namespace tread::solver
{

/// Calls act(page key, from, to) for each run of a row's points, from <= k < to, that lies in one page.
template<class Act>
void for_each_page_run(const mpm::Lattice& lattice, const world::PointRow& row, const Act& act)
{
    const auto page_at = [&](std::uint32_t k) { return mpm::page_of(mpm::cell_of(row.at(k), lattice)); };
    for (std::uint32_t from = 0, to = 0; from < row.count; from = to)
    {
        const mpm::Index3 page = page_at(from);
        do {
            ++to;
        } while (to < row.count && page_at(to).x == page.x);
        act(mpm::page_key(page), from, to);
    }
}

} // namespace tread::solver
