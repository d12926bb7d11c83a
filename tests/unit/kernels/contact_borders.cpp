#include <vector>

#include "dem_scene.hpp"
#include "kernels/contact/borders.hpp"

// Bodies near pages of other ranks: which of them the host hears of.
namespace tread::test
{
namespace contact_borders_test
{

constexpr double               radius = 0.1, allowed = 0.05;
constexpr contact::BorderReach reach{0.2, 0.15, 0.6};

template<class Exec>
class Borders : public DemTest<Exec>
{
protected:
    using Scene = SolidScene<Exec>;

    /// Four balls in a row along x; the last is a ghost. The second is large.
    static Scene row(const Exec& exec)
    {
        std::vector<Solid> solids;
        for (int i = 0; i < 4; ++i) { solids.push_back(solid_sphere(radius, 2000, {i + 0.5, 0.5, 0.5})); }
        Scene scene(exec, {exact_sphere()}, solids, {});
        scene.pairs.displacement.allowed.assign(std::vector<double>(4, allowed));
        scene.pairs.sizes.is_large.assign({0, 1, 0, 0});
        scene.bodies.role.assign({dem::role_owner, dem::role_owner, dem::role_owner, dem::role_ghost});
        return scene;
    }

    static Array<Exec, double> bounding_radii(const Exec& exec)
    {
        Array<Exec, double> radii(exec, "radii");
        radii.assign(std::vector<double>(4, radius));
        return radii;
    }

    static contact::Borders<Exec> borders(const Exec& exec)
    {
        contact::Borders<Exec> made(exec);
        contact::begin_borders(exec, made, 4);
        return made;
    }

    static std::vector<std::int32_t> listed(const Exec& exec, Scene& scene, contact::Borders<Exec>& borders)
    {
        const Array<Exec, double> radii = bounding_radii(exec);
        contact::list_borders(exec, borders, radii.data(), scene.pairs, scene.bodies.view(), reach);
        return borders.body.to_host();
    }

    /// Further than the balls found last reach by 0.2 m for bodies, and by 0.1 m for sand.
    static std::vector<contact::Clearance> clear(const contact::Borders<Exec>& borders)
    {
        std::vector<contact::Clearance> found;
        for (const contact::BorderBody& ball : borders.ball.to_host())
        {
            found.push_back({ball.position, {ball.reach.bodies + 0.2, ball.reach.sand + 0.1}});
        }
        return found;
    }
};
TYPED_TEST_SUITE(Borders, Backends, BackendNames);

using Bodies = std::vector<std::int32_t>;

/// Radii: own reach, and what may meet the body. A ghost is its owner's.
TYPED_TEST(Borders, WhatIsNotKnownIsListed)
{
    auto scene = this->row(this->exec());
    auto found = this->borders(this->exec());
    EXPECT_EQ(this->listed(this->exec(), scene, found), (Bodies{0, 1, 2}));
    const auto balls = found.ball.to_host();
    EXPECT_EQ(balls[0].reach.bodies, radius + allowed + reach.met_by_small);
    EXPECT_EQ(balls[0].reach.sand, radius + allowed + reach.sand);
    EXPECT_EQ(balls[1].reach.bodies, radius + allowed + reach.met_by_large);
    EXPECT_EQ(balls[2].position, Vec3<double>(2.5, 0.5, 0.5));
}

/// Until it may leave the balls of the last decision, or owners of pages change.
TYPED_TEST(Borders, WhatIsDecidedStaysOnTheBackend)
{
    auto scene = this->row(this->exec());
    auto found = this->borders(this->exec());
    this->listed(this->exec(), scene, found);
    contact::keep_clearances(this->exec(), found, found.body.to_host(), this->clear(found));
    EXPECT_EQ(this->listed(this->exec(), scene, found), Bodies{});

    auto position = scene.bodies.position.to_host();
    position[0][0] += 0.09;
    position[2][1] += 0.11; // sand of another rank may be there
    scene.bodies.position.assign(position);
    EXPECT_EQ(this->listed(this->exec(), scene, found), Bodies{2});

    scene.pairs.displacement.allowed.assign({allowed, allowed + 0.11, allowed, allowed});
    EXPECT_EQ(this->listed(this->exec(), scene, found), (Bodies{1, 2}));
    auto further = this->clear(found); // of the two listed
    further[0].within.sand += 1;
    further[1].within.sand += 1;
    further[1].within.bodies -= 0.21;
    contact::keep_clearances(this->exec(), found, found.body.to_host(), further);
    EXPECT_EQ(this->listed(this->exec(), scene, found), Bodies{2}) << "another body may be there";
    contact::forget_clearances(this->exec(), found);
    EXPECT_EQ(this->listed(this->exec(), scene, found), (Bodies{0, 1, 2}));
}

TYPED_TEST(Borders, LargestReachesAreThoseOfOwnBodies)
{
    auto       scene = this->row(this->exec());
    const auto radii = this->bounding_radii(this->exec());
    scene.pairs.displacement.allowed.assign({0.01, 0.03, 0.02, 9.0});
    const auto largest = contact::largest_reaches(this->exec(), radii.data(), scene.pairs, scene.bodies.view());
    EXPECT_EQ(largest[0], radius + 0.03);
    EXPECT_EQ(largest[1], radius + 0.02) << "of small ones";
}

TYPED_TEST(Borders, PlacesAreSetOneByOne)
{
    Array<TypeParam, std::int32_t> body(this->exec(), "bodies"), place(this->exec(), "places");
    place.assign({4, 5, 6, 7});
    contact::forget_places(this->exec(), place);
    body.assign({1, 3});
    contact::write_places(this->exec(), body, place);
    EXPECT_EQ(place.to_host(), (Bodies{-1, 0, -1, 1}));
}

} // namespace contact_borders_test
} // namespace tread::test
