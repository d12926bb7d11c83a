#include <iostream>
#include <set>

#include "bed_scenes.hpp"
#include "mpi_session.hpp"
#include "solver/ranks/page_loads.hpp"
#include "solver/sand/point_upload.hpp"

// The points that ranks make for themselves, together, against those that one makes alone.
namespace
{

using namespace tread;

/// Numbers of a point that is made, in an order of its own.
std::vector<double> numbers(const world::HostPoints& points, std::size_t i)
{
    std::vector<double> all(points.position[i].data(), points.position[i].data() + 3);
    all.insert(all.end(), points.stress[i].data(), points.stress[i].data() + 6);
    all.insert(all.end(), {points.volume[i], points.mass[i], double(points.material[i]), double(points.terrain[i])});
    if (!points.velocity.empty()) { all.insert(all.end(), points.velocity[i].data(), points.velocity[i].data() + 3); }
    if (!points.plastic_shear.empty()) { all.push_back(points.plastic_shear[i]); }
    return all;
}

/// Exactly: the bits of a point do not depend on how many ranks there are, nor on which of them makes it.
TEST(RankParts, TogetherAreTheBedOfOneRankToTheBit)
{
    const Communicator&            ranks = test::world();
    const test::TemporaryDirectory folder;
    for (const test::BedScene& bed : test::bed_scenes(folder))
    {
        const world::World              world = world::build_world(bed.scene);
        Counters                        counters;
        decomp::Decomposition<Cpu>      decomposition(ranks, Cpu{&counters}, {});
        const std::string               partition = solver::share_out(decomposition, world);
        const world::HostPoints         own       = solver::own_points(bed.scene, world, decomposition);
        const world::HostPoints         all       = world::make_points(bed.scene, world, world.sand.rows);
        const std::vector<std::int32_t> ids    = ranks.gather(std::vector<std::int32_t>(own.id.begin(), own.id.end()));
        const std::vector<std::int64_t> counts = ranks.gather(static_cast<std::int64_t>(own.size()));
        const auto                      most   = *std::max_element(counts.begin(), counts.end());
        for (std::size_t i = 0; i < own.size(); ++i) { ASSERT_EQ(numbers(own, i), numbers(all, own.id[i])); }
        EXPECT_EQ(ids.size(), all.size());
        EXPECT_EQ(std::set<std::int32_t>(ids.begin(), ids.end()).size(), all.size());
        if (ranks.rank() > 0) { continue; }
        const double share = static_cast<double>(most) * ranks.size() / static_cast<double>(all.size());
        std::cout << "[ ranks    ] " << bed.name << ": at most " << most << " of " << all.size() << " points on one of "
                  << ranks.size() << " ranks; " << partition << '\n';
        // The partitioner may load a rank by 1.05 of the mean; rocks count, and a page is a twentieth of a share.
        EXPECT_LT(share, 1.15) << "of an even share";
    }
}

} // namespace
