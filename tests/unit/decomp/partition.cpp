#include "decomp/partition.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mpi_session.hpp"
#include "pages.hpp"

// Results of partitioners, and fallbacks where they fail (METIS 5.1 crashes with one part, and uneven loads leave ranks
// empty).
namespace tread::decomp
{
namespace
{

PartitionOptions by(Partitioner partitioner, int ranks)
{
    PartitionOptions options;
    options.ranks       = ranks;
    options.partitioner = partitioner;
    return options;
}

std::vector<Partitioner> partitioners()
{
    std::vector<Partitioner> built{Partitioner::metis, Partitioner::morton};
    if (petsc_is_built_in()) { built.push_back(Partitioner::petsc); }
    return built;
}

void expect_valid(const PageGraph& graph, const Partition& found, int ranks)
{
    ASSERT_EQ(found.rank.size(), graph.pages());
    for (const std::int32_t rank : found.rank)
    {
        EXPECT_GE(rank, 0);
        EXPECT_LT(rank, ranks);
    }
    const int with_pages = static_cast<int>(std::set<std::int32_t>(found.rank.begin(), found.rank.end()).size());
    EXPECT_EQ(with_pages, std::min<int>(ranks, static_cast<int>(graph.pages())));
}

TEST(Partition, CutsABlockWhereItIsThin)
{
    const PageGraph graph = test::block(16, 4, 4);
    for (const Partitioner partitioner : partitioners())
    {
        const Partition        found   = make_partition(test::world(), graph, by(partitioner, 2));
        const PartitionQuality quality = quality_of(graph, found.rank, 2);
        expect_valid(graph, found, 2);
        EXPECT_EQ(found.fallback, "");
        EXPECT_LE(quality.imbalance, 1.05);
        // A plane across the block: 16 faces of 72 nodes, 48 edges of 24, 36 corners of 8.
        const std::int64_t plane = 16 * 72 + 48 * 24 + 36 * 8;
        std::printf("cut %ld nodes, a plane's %ld; halo %ld pages; imbalance %.3f\n", static_cast<long>(quality.cut),
                    static_cast<long>(plane), static_cast<long>(quality.halo), quality.imbalance);
        EXPECT_LE(quality.cut, plane + plane / 2);
        EXPECT_GE(quality.cut, plane);
        EXPECT_EQ(quality.empty, 0);
    }
}

TEST(Partition, IsTheSameEveryTime)
{
    const PageGraph graph = test::block(9, 7, 5);
    for (const Partitioner partitioner : partitioners())
    {
        EXPECT_EQ(make_partition(test::world(), graph, by(partitioner, 4)).rank,
                  make_partition(test::world(), graph, by(partitioner, 4)).rank);
    }
}

TEST(Partition, OfOneRankIsOne)
{
    const PageGraph graph = test::block(4, 4, 4);
    for (const Partitioner partitioner : partitioners())
    {
        const Partition found = make_partition(test::world(), graph, by(partitioner, 1));
        expect_valid(graph, found, 1);
        EXPECT_EQ(found.fallback, "");
    }
}

TEST(Partition, HasNoEmptyRankWhileThereArePages)
{
    for (const int pages : {1, 2, 3, 4, 5, 8, 9, 17})
    {
        const PageGraph graph = test::block(pages, 1, 1);
        for (const int ranks : {2, 3, 4, 8})
        {
            for (const Partitioner partitioner : partitioners())
            {
                SCOPED_TRACE(std::to_string(pages) + " pages, " + std::to_string(ranks) + " ranks");
                const Partition found = make_partition(test::world(), graph, by(partitioner, ranks));
                expect_valid(graph, found, ranks);
                if (partitioner != Partitioner::morton && pages < ranks) { EXPECT_NE(found.fallback, ""); }
            }
        }
    }
}

TEST(Partition, OfNoPagesIsEmpty)
{
    const PageGraph nothing = page_graph({}, {});
    for (const Partitioner partitioner : partitioners())
    {
        EXPECT_TRUE(make_partition(test::world(), nothing, by(partitioner, 4)).rank.empty());
    }
}

TEST(Partition, SurvivesLoadsOfZero)
{
    const PageGraph graph = test::block(6, 6, 2, [](mpm::Index3) { return 0.0; });
    for (const Partitioner partitioner : partitioners())
    {
        expect_valid(graph, make_partition(test::world(), graph, by(partitioner, 4)), 4);
    }
}

/// A wheel's page may weigh more than all others together.
TEST(Partition, SurvivesLoadsThatCannotBeBalanced)
{
    for (const double heavy : {1e2, 1e5, 1e12})
    {
        const PageGraph graph = test::block(
            8, 8, 2, [&](mpm::Index3 page) { return page.x == 3 && page.y == 3 && page.z == 0 ? heavy : 1.0; });
        for (const Partitioner partitioner : partitioners())
        {
            const Partition found = make_partition(test::world(), graph, by(partitioner, 4));
            expect_valid(graph, found, 4);
            std::printf("one page of %g: imbalance %.3f, by %s\n", heavy, quality_of(graph, found.rank, 4).imbalance,
                        found.fallback.empty() ? "choice" : found.fallback.c_str());
        }
    }
}

TEST(Partition, TakesHeapsApart)
{
    std::vector<mpm::Index3> pages;
    for (int heap = 0; heap < 5; ++heap)
    {
        for (int i = 0; i < 27; ++i) { pages.push_back({100 * heap + i % 3, i / 3 % 3, i / 9}); }
    }
    const PageGraph graph = test::graph_of(pages);
    for (const Partitioner partitioner : partitioners())
    {
        expect_valid(graph, make_partition(test::world(), graph, by(partitioner, 4)), 4);
    }
}

TEST(Partition, MortonChunksAreRunsOfNearlyEqualLoad)
{
    std::mt19937                           random(3);
    std::uniform_real_distribution<double> load(0, 1);
    const PageGraph                        graph = test::block(20, 20, 3, [&](mpm::Index3) { return load(random); });
    const PageRanks                        rank  = morton_chunks(graph, 7);
    EXPECT_TRUE(std::is_sorted(rank.begin(), rank.end()));
    // Each end of a run is off by at most half a page: one page in total, of 1200 with a mean load of a half.
    EXPECT_LT(quality_of(graph, rank, 7).imbalance, 1 + 1.0 / (1200 * 0.5 / 7));
}

TEST(Partition, NamesStayWhereMostLoadIs)
{
    const PageGraph graph   = test::block(8, 8, 1);
    const PageRanks present = morton_chunks(graph, 4);
    PageRanks       parts   = present;
    for (std::int32_t& part : parts) { part = (part + 1) % 4; } // the same parts with other labels
    EXPECT_EQ(stay_put(parts, present, graph.load, 4), present);

    parts[0] = parts[63]; // one page moves
    EXPECT_EQ(stay_put(parts, present, graph.load, 4)[0], present[63]);
    const PageRanks fresh(64, -1);
    const PageRanks named = stay_put(parts, fresh, graph.load, 4);
    EXPECT_EQ(std::set<std::int32_t>(named.begin(), named.end()).size(), 4u);
}

} // namespace
} // namespace tread::decomp
