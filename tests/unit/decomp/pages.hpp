#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "decomp/page_graph.hpp"
#include "kernels/mpm/pages/page_key.hpp"

// Page sets for tests.
namespace tread::test
{

using LoadOf = std::function<double(mpm::Index3)>;

inline decomp::PageGraph graph_of(
    const std::vector<mpm::Index3>& pages, const LoadOf& load_of = [](mpm::Index3) { return 1.0; })
{
    std::vector<std::uint64_t> key;
    key.reserve(pages.size());
    for (const mpm::Index3& page : pages) { key.push_back(mpm::page_key(page)); }
    std::sort(key.begin(), key.end());
    std::vector<double> load;
    load.reserve(key.size());
    for (const std::uint64_t page : key) { load.push_back(load_of(mpm::page_coordinates(page))); }
    return decomp::page_graph(key, load);
}

/// A box of pages.
inline decomp::PageGraph block(
    int nx, int ny, int nz, const LoadOf& load_of = [](mpm::Index3) { return 1.0; })
{
    std::vector<mpm::Index3> pages;
    for (int i = 0; i < nx * ny * nz; ++i) { pages.push_back({i % nx, i / nx % ny, i / (nx * ny)}); }
    return graph_of(pages, load_of);
}

} // namespace tread::test
