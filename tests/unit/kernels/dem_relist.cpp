#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "base/random.hpp"
#include "dem_scene.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"
#include "kernels/dem/pairs/relist.hpp"

namespace tread::test
{
namespace
{

constexpr double step = 1e-3; // s

/// Boxes, spheres with nodes, and exact spheres, of 1 to 2 cm, some touching, over a floor; one is large.
std::vector<Solid> pile(Random& random)
{
    std::vector<Solid> solids;
    for (int i = 0; i < 200; ++i)
    {
        const Vec3<double> place(random.uniform(0, 0.12), random.uniform(0, 0.12), random.uniform(0.01, 0.1));
        solids.push_back(solid_sphere(i == 77 ? 0.05 : random.uniform(0.005, 0.01), 2000, place));
        solids.back().shape    = i % 3;
        solids.back().velocity = Vec3<double>(random.uniform(-0.1, 0.1), 0, 0);
    }
    return solids;
}

std::vector<SolidShape> shapes() { return {unit_sphere(3, 40), box_solid({0.8, 1, 1.2}, 10, 40), exact_sphere()}; }

SolidNumbers floor_below()
{
    SolidNumbers numbers;
    numbers.planes = {{{0, 0, 1}, 0.0, false}};
    return numbers;
}

Vec3<double> any_way(Random& random)
{
    return Vec3<double>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
}

template<class Exec>
class Relisted : public DemTest<Exec>
{
protected:
    using Scene = typename DemTest<Exec>::Scene;

    /// Moves every tenth body beyond what the list allows, and the others within it. Returns whether each is to be
    /// relisted: those that have used more than three quarters.
    std::vector<bool> move(Scene& scene, Random& random)
    {
        const std::vector<double> allowed = scene.pairs.displacement.allowed.to_host();
        std::vector<Vec3<double>> places  = scene.bodies.position.to_host();
        std::vector<bool>         far;
        for (std::size_t b = 0; b < places.size(); ++b)
        {
            far.push_back(random.uniform(0, 1) < 0.1);
            places[b] += allowed[b] * (far.back() ? random.uniform(2, 8) : random.uniform(0, 0.2)) * any_way(random);
        }
        scene.bodies.position.assign(places);
        return far;
    }

    /// A new list of which most is the last.
    std::int64_t relist(Scene& scene, dem::DisplacementTracker<Exec>& places)
    {
        const Exec&           exec   = this->exec();
        const dem::BodiesView bodies = scene.bodies.view();
        largest_displacement(exec, places, bodies, scene.law().templates, scene.pairs.displacement.allowed.data());
        const std::int64_t strayed = mark_strayed(exec, scene.pairs, bodies, places.share.data());
        const auto*        mark    = scene.pairs.relisting.mark.data();
        mark_places(exec, places, bodies, mark);
        begin_list(exec, scene.pairs, bodies, scene.law());
        request_displacement(exec, scene.pairs, bodies, scene.law(), step, {});
        allow_displacement(exec, scene.pairs, bodies, scene.law(), step, 1, mark);
        dem::BodiesView at_search = bodies;
        at_search.position        = places.position.data();
        at_search.orientation     = places.orientation.data();
        relist_pairs(exec, scene.pairs, bodies, at_search, scene.law());
        return strayed;
    }

    /// A search of all bodies of `whole`, at `places`, with the displacements that `scene` allows.
    void search(Scene& whole, const dem::DisplacementTracker<Exec>& places, const Scene& scene)
    {
        const Exec& exec = this->exec();
        whole.bodies.position.assign(places.position.to_host());
        begin_list(exec, whole.pairs, whole.bodies.view(), whole.law());
        request_displacement(exec, whole.pairs, whole.bodies.view(), whole.law(), step, {});
        whole.pairs.displacement.allowed.assign(scene.pairs.displacement.allowed.to_host());
        Array<Exec, std::int32_t> none(exec, "no marks");
        none.assign(std::vector<std::int32_t>(static_cast<std::size_t>(whole.bodies.position.size()), 0));
        allow_displacement(exec, whole.pairs, whole.bodies.view(), whole.law(), step, 1, none.data());
        list_pairs(exec, whole.pairs, whole.bodies.view(), whole.law());
    }
};
TYPED_TEST_SUITE(Relisted, Backends, BackendNames);

/// Five lists in a row: each is, to the node, what a search of all bodies finds at the places where each was found.
TYPED_TEST(Relisted, ListIsThatOfASearchOfAll)
{
    Random                              random(11);
    const std::vector<Solid>            solids = pile(random);
    typename TestFixture::Scene         scene(this->exec(), shapes(), solids, floor_below());
    typename TestFixture::Scene         whole(this->exec(), shapes(), solids, floor_below());
    dem::DisplacementTracker<TypeParam> places(this->exec());
    scene.find(step);
    mark_places(this->exec(), places, scene.bodies.view());
    std::vector<std::uint64_t> before = scene.pairs.key.to_host();
    for (int list = 0; list < 5; ++list)
    {
        const std::vector<bool> far     = this->move(scene, random);
        const std::int64_t      strayed = this->relist(scene, places);
        EXPECT_GE(strayed, std::count(far.begin(), far.end(), true));
        EXPECT_LT(strayed, 80);
        this->search(whole, places, scene);

        const auto keys = scene.pairs.key.to_host();
        EXPECT_EQ(keys, whole.pairs.key.to_host());
        EXPECT_EQ(scene.pairs.nodes.first.to_host(), whole.pairs.nodes.first.to_host());
        EXPECT_EQ(scene.pairs.nodes.node.to_host(), whole.pairs.nodes.node.to_host());
        std::vector<std::uint64_t> fresh;
        std::set_difference(keys.begin(), keys.end(), before.begin(), before.end(), std::back_inserter(fresh));
        std::printf("%lld of 200 bodies strayed, %zu pairs, %zu of them new, %lld nodes\n",
                    static_cast<long long>(strayed), keys.size(), fresh.size(),
                    static_cast<long long>(scene.pairs.nodes.node.size()));
        EXPECT_GT(fresh.size(), 10u);
        before = keys;
    }
}

/// At the bodies' present places, forces are those of a search there.
TYPED_TEST(Relisted, ForcesAreThoseOfASearch)
{
    Random                              random(12);
    const std::vector<Solid>            solids = pile(random);
    typename TestFixture::Scene         scene(this->exec(), shapes(), solids, floor_below());
    typename TestFixture::Scene         whole(this->exec(), shapes(), solids, floor_below());
    dem::DisplacementTracker<TypeParam> places(this->exec());
    scene.find(step);
    mark_places(this->exec(), places, scene.bodies.view());
    this->move(scene, random);
    this->relist(scene, places);
    whole.bodies.position.assign(scene.bodies.position.to_host());
    whole.find(step);
    scene.contact(1e-5);
    whole.contact(1e-5);
    const auto expected = whole.bodies.force.to_host(), got = scene.bodies.force.to_host();
    double     largest = 0, worst = 0;
    for (std::size_t b = 0; b < expected.size(); ++b)
    {
        largest = std::max(largest, expected[b].norm());
        worst   = std::max(worst, (got[b] - expected[b]).norm());
    }
    std::printf("forces up to %.3e N, differing by %.1e; tolerance 1e-12 of the largest (order of the sums)\n", largest,
                worst);
    EXPECT_GT(largest, 1.0);
    EXPECT_LT(worst, 1e-12 * largest);
}

} // namespace
} // namespace tread::test
