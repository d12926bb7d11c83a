#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "base/random.hpp"
#include "dem_bumpy.hpp"
#include "kernels/dem/contact/near_nodes_kern.hpp"

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

/// How many nodes were near and entered when moved straight, and how far from its bound a node was on the wrong side of
/// it, over the rounding.
struct Compared
{
    int    near     = 0;
    int    far      = 0;
    int    entering = 0;
    double wrong    = 0;
};

template<class Field>
void compare(const dem::Side<Field>& side, const dem::TemplateView* other, double way, Compared& all)
{
    const dem::PlacedNodes placed = dem::place_nodes(side, way);
    const dem::NearNodes   nodes  = dem::near_nodes(side.owner.shape, other, placed);
    const double           bound  = side.field.bound_of_node(way);
    for (std::int32_t i = 0; i < side.owner.shape->node_count; ++i)
    {
        const dem::SdfSample sample = side.field(side.node(i));
        const double         beyond = sample.distance - bound;
        const bool           near   = nodes.has_node(i);
        const Vec3<double>   moved  = side.node(i) - way * sample.gradient.normalized();
        (near ? all.near : all.far) += 1;
        ASSERT_TRUE(near || beyond > 0) << "a node is missing that is " << -beyond << " m within its bound";
        const bool enters = side.field(moved).distance <= 0;
        all.entering += enters ? 1 : 0;
        ASSERT_TRUE(!enters || nodes.has_part(i / dem::part_size)) << "the part of a node that enters is missing";
        if (near) { all.wrong = std::max(all.wrong, beyond / placed.rounding); }
    }
}

/// Nodes are found in single precision: none is missing that double precision finds, those too many are nearer to their
/// bound than twice what it was raised by, and no part is left out with a node that enters when it moves straight.
/// Bodies of unlike size touch each other and a wall anywhere, 1 km from the origin.
TEST(NearNodes, AreThoseOfDoublePrecisionAndFewMore)
{
    const BumpyBody body(40);
    Counters        counters;
    Random          random(11);
    Compared        all;
    const auto any = [&] { return Vec3<double>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    for (int trial = 0; trial < 400; ++trial)
    {
        const double       scale = trial % 2 == 0 ? 0.01 : 0.5, other = 0.01;
        const Vec3<double> apart = random.uniform(0.8, 1.2) * (scale + other) * any().normalized(), far(1000, 0, 0);
        std::vector<Solid> solids{{.scale = scale, .position = far}, {.scale = other, .position = far + apart}};
        for (Solid& solid : solids) { solid.orientation = Quat(Eigen::AngleAxisd(3, any().normalized())); }
        SolidScene<Cpu> scene(Cpu{&counters}, {body.shape(642)}, solids, {});
        const auto      at = [&](std::int64_t b)
        { return dem::instance_of(scene.bodies.view(), scene.law().templates, b, solids[0].position); };
        const dem::Couple                        couple{{at(0), at(1)}};
        const dem::TwoSides<dem::MeetByDistance> sides{{}, couple};
        const double                             way = other * random.uniform(0.001, 0.2);
        compare(sides.first(), couple.body[1].shape, way, all);
        compare(sides.second(), couple.body[0].shape, way, all);
        const dem::PlaneField wall{any().normalized(), random.uniform(-1, 1) * scale};
        compare(dem::Side<dem::PlaneField>{couple.body[0], wall, 1.0, 1.0}, nullptr, way, all);
    }
    std::printf("%d nodes near, of them %d enter, %d not; the furthest beyond its bound by %.2f of the rounding\n",
                all.near, all.entering, all.far, all.wrong);
    EXPECT_LE(all.wrong, 2);
    EXPECT_GT(all.wrong, 0) << "else none was that near to its bound";
    EXPECT_GT(all.entering, 1000);
}

} // namespace
} // namespace tread::test
