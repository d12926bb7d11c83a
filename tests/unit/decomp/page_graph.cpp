#include "decomp/page_graph.hpp"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "kernels/mpm/pages/page_key.hpp"
#include "pages.hpp"

namespace tread::decomp
{
namespace
{

/// Number of nodes that the stencils of two pages share, counted directly.
int shared_by_count(mpm::Index3 a, mpm::Index3 b)
{
    int        shared = 0;
    const auto within = [](std::int32_t node, std::int32_t page)
    { return node >= page * mpm::page_edge && node < page * mpm::page_edge + mpm::tile_edge; };
    for (std::int32_t z = -8; z < 24; ++z)
    {
        for (std::int32_t y = -8; y < 24; ++y)
        {
            for (std::int32_t x = -8; x < 24; ++x)
            {
                shared += within(x, a.x) && within(y, a.y) && within(z, a.z) && within(x, b.x) && within(y, b.y) &&
                                  within(z, b.z)
                              ? 1
                              : 0;
            }
        }
    }
    return shared;
}

TEST(PageGraph, EdgesAreTheNodesThatTwoPagesShare)
{
    const PageGraph graph = test::block(3, 3, 3);
    ASSERT_EQ(graph.pages(), 27u);
    ASSERT_EQ(graph.first.size(), 28u);
    std::map<std::int64_t, int> degrees;
    for (std::size_t page = 0; page < graph.pages(); ++page)
    {
        ++degrees[graph.first[page + 1] - graph.first[page]];
        for (std::int64_t edge = graph.first[page]; edge < graph.first[page + 1]; ++edge)
        {
            const auto        e     = static_cast<std::size_t>(edge);
            const std::size_t other = static_cast<std::size_t>(graph.neighbour[e]);
            EXPECT_EQ(graph.shared[e],
                      shared_by_count(mpm::page_coordinates(graph.key[page]), mpm::page_coordinates(graph.key[other])));
            const auto back =
                std::find(graph.neighbour.begin() + graph.first[other],
                          graph.neighbour.begin() + graph.first[other + 1], static_cast<std::int32_t>(page));
            ASSERT_NE(back, graph.neighbour.begin() + graph.first[other + 1]) << "an edge that stands once";
            EXPECT_EQ(graph.shared[static_cast<std::size_t>(back - graph.neighbour.begin())], graph.shared[e]);
        }
    }
    EXPECT_EQ(degrees, (std::map<std::int64_t, int>{{7, 8}, {11, 12}, {17, 6}, {26, 1}}));
}

TEST(PageGraph, PagesApartHaveNoEdge)
{
    const PageGraph graph = test::graph_of({{0, 0, 0}, {2, 0, 0}, {-5, 3, 7}});
    EXPECT_EQ(graph.neighbour.size(), 0u);
    EXPECT_EQ(graph.first, (std::vector<std::int64_t>{0, 0, 0, 0}));
}

TEST(PageGraph, OfNothingIsEmpty)
{
    const PageGraph graph = page_graph({}, {});
    EXPECT_EQ(graph.pages(), 0u);
    EXPECT_EQ(graph.first, (std::vector<std::int64_t>{0}));
}

} // namespace
} // namespace tread::decomp
