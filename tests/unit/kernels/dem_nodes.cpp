#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "dem_scene.hpp"
#include "kernels/dem/contact/body_field_kern.hpp"

// Lists of the nodes that may touch (contact_nodes.hpp).
namespace tread::test
{
namespace
{

template<class Exec>
class ContactNodes : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(ContactNodes, Backends, BackendNames);

/// Number of clusters, of either body, that have nodes in a list.
std::size_t clusters_of(const std::vector<std::int32_t>& nodes)
{
    std::set<std::int32_t> clusters;
    for (const std::int32_t node : nodes)
    {
        clusters.insert(node >= 0 ? node / dem::cluster_size : ~(~node / dem::cluster_size));
    }
    return clusters.size();
}

/// The search records up to seven clusters of a pair and looks again for more (near_clusters): as two balls are allowed
/// more and more displacement, their list only grows, past that number as before it.
TYPED_TEST(ContactNodes, GrowWithTheAllowedDisplacement)
{
    constexpr double   radius = 0.01, speed = 0.1;                     // m, m/s
    const Vec3<double> way = Vec3<double>(0.8, 0.5, 0.3).normalized(); // along no symmetry of the balls' nodes
    std::vector<Solid> solids{solid_sphere(radius, 1000, {0, 0, 0}), solid_sphere(radius, 1000, 2.03 * radius * way)};
    solids[1].orientation = Quat(Eigen::AngleAxisd(0.7, Vec3<double>(0.3, -0.2, 0.9).normalized()));
    solids[1].velocity    = -speed * way;
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(3, 40)}, solids, {});
    std::set<std::int32_t>      before;
    std::set<std::size_t>       clusters;
    constexpr int               lists = 300;
    for (int list = 1; list <= lists; ++list)
    {
        scene.find(0.1 * radius / speed * list / lists);
        const std::vector<std::int32_t> nodes = scene.pairs.nodes.node.to_host();
        const std::set<std::int32_t>    now(nodes.begin(), nodes.end());
        ASSERT_EQ(now.size(), nodes.size()) << "a node is listed twice";
        ASSERT_TRUE(std::includes(now.begin(), now.end(), before.begin(), before.end())) << "list " << list;
        before = now;
        clusters.insert(clusters_of(nodes));
    }
    std::printf("%d lists of up to %zu nodes, in %zu to %zu clusters\n", lists, before.size(), *clusters.begin(),
                *clusters.rbegin());
    for (std::size_t number = dem::near_clusters - 2; number <= dem::near_clusters + 1; ++number)
    {
        EXPECT_TRUE(clusters.contains(number)) << number;
    }
}

} // namespace
} // namespace tread::test
