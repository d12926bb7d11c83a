#include <algorithm>
#include <vector>

#include "dem_scene.hpp"
#include "kernels/contact/beds.hpp"
#include "kernels/dem/sleep/sleep.hpp"
#include "kernels/mpm/pages/page_key.hpp"

// Which sand bodies may touch, and who of them falls asleep and wakes with it.
namespace tread::test
{
namespace contact_beds_test
{

constexpr double           radius = 0.1, reach = 0.05;
constexpr mpm::PageLattice lattice{0.25, 0.5}; // pages of 1 m, the first from 0.125 m on

using Marks = std::vector<std::int32_t>;
using Keys  = std::vector<std::uint64_t>;

template<class Exec>
class Beds : public DemTest<Exec>
{
protected:
    using Scene = SolidScene<Exec>;

    /// Balls along x, on pages of a row.
    static Scene balls(const Exec& exec, const std::vector<double>& x)
    {
        std::vector<Solid> solids;
        for (const double at : x) { solids.push_back(solid_sphere(radius, 2000, {at, 0.6, 0.6})); }
        return Scene(exec, {exact_sphere()}, solids, {});
    }

    /// Beds of the balls, where these pages of the row have awake points and these sleep.
    static Marks beds(const Exec& exec, Scene& scene, const std::vector<int>& awake, const std::vector<int>& asleep)
    {
        constexpr int             listed = 8; // pages without points are listed, too
        Keys                      keys, sleeping;
        std::vector<std::int32_t> first{0};
        for (int x = 0; x < listed; ++x)
        {
            keys.push_back(mpm::page_key({x, 0, 0}));
            first.push_back(first.back() + (std::find(awake.begin(), awake.end(), x) != awake.end() ? 5 : 0));
        }
        for (const int x : asleep) { sleeping.push_back(mpm::page_key({x, 0, 0})); }
        Array<Exec, std::uint64_t> key(exec, "test pages"), asleep_key(exec, "test sleeping pages");
        Array<Exec, std::int32_t>  first_point(exec, "test points"), bed(exec, "test beds", scene.bodies.view().count);
        key.assign(keys);
        asleep_key.assign(sleeping);
        first_point.assign(first);
        contact::find_beds(exec, scene.bodies.view(), scene.law().templates,
                           {lattice, {listed, key.data()}, first_point.data(), {asleep_key.size(), asleep_key.data()}},
                           reach, bed.data());
        return bed.to_host();
    }
};
TYPED_TEST_SUITE(Beds, Backends, BackendNames);

/// Pages 0 and 1 are awake, 3 sleeps, the others have no points. Borders of pages are at whole metres and 0.125 m.
TYPED_TEST(Beds, SleepingSandCountsBeforeAwakeSand)
{
    auto scene = this->balls(this->exec(), {0.6, 2.6, 3.6, 2.27, 2.28, 2.97, 2.98, 7.6});
    EXPECT_EQ(this->beds(this->exec(), scene, {0, 1}, {3}),
              (Marks{dem::bed_awake, dem::bed_none, dem::bed_asleep, dem::bed_awake, dem::bed_none, dem::bed_none,
                     dem::bed_asleep, dem::bed_none}));
    EXPECT_EQ(this->beds(this->exec(), scene, {2, 3}, {3})[2], dem::bed_asleep); // points have entered a sleeping page
    EXPECT_EQ(this->beds(this->exec(), scene, {2}, {3})[6], dem::bed_asleep);    // both
}

/// Who rests falls asleep with its sand, and wakes with it alone and at rest; who does not stays awake.
TYPED_TEST(Beds, BodiesFollow)
{
    auto  scene = this->balls(this->exec(), {0.6, 1.6, 2.6});
    auto& sleep = scene.pairs.sleep;
    dem::begin_sleep(this->exec(), scene.pairs, scene.bodies, {1e-3, 0.1, 0.5, 0});
    sleep.quiet.assign({0.2, 0.2, 0.05});
    sleep.bed.assign(Marks(3, dem::bed_awake));
    sleep.next_bed.assign({dem::bed_asleep, dem::bed_awake, dem::bed_asleep});
    dem::SleepCount count = dem::follow_beds(this->exec(), scene.pairs, scene.bodies.view());
    EXPECT_EQ(count.tired, 1);
    EXPECT_EQ(count.wake, 0);
    EXPECT_EQ(count.awake, 3);
    EXPECT_EQ(sleep.mark.to_host(), (Marks{dem::mark_tired, dem::mark_none, dem::mark_none}));

    scene.bodies.asleep.assign({1, 1, 0});
    sleep.next_bed.assign({dem::bed_none, dem::bed_none, dem::bed_awake}); // points that wake are in no page yet
    count = dem::follow_beds(this->exec(), scene.pairs, scene.bodies.view());
    EXPECT_EQ(count.tired, 0);
    EXPECT_EQ(count.wake, 1); // the second sleeps by itself
    EXPECT_EQ(sleep.mark.to_host(), (Marks{dem::mark_wakes_calm, dem::mark_none, dem::mark_none}));
    EXPECT_EQ(sleep.bed.to_host(), (Marks{dem::bed_awake, dem::bed_none, dem::bed_awake}));

    sleep.wakes = true;
    scene.find(1e-3);
    EXPECT_EQ(scene.bodies.asleep.to_host(), (Marks{0, 1, 0}));
    EXPECT_EQ(sleep.quiet.to_host()[0], 0.1); // at rest until it is seen to move
    EXPECT_FALSE(sleep.woken);                // no other sand wakes for it
}

} // namespace contact_beds_test
} // namespace tread::test
