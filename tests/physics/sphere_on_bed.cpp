#include <numbers>

#include "sphere_on_bed.hpp"

namespace
{

using namespace tread;

template<class Exec>
class FullSizeSphereOnBed : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeSphereOnBed, test::Backends, test::BackendNames);

constexpr double mm = 1e-3;

/// docs/verification.md#points-during-the-substeps: a point that recoils freely in the substeps unloads its tangential
/// spring in every step, and a sphere that friction should hold creeps at 41 mm/s. With the grid's acceleration applied
/// to the points, it stays as with N = 1.
TYPED_TEST(FullSizeSphereOnBed, FrictionHoldsItAgainstASidewaysForce)
{
    test::SphereOnBed bed;
    bed.sideways         = 0.15;
    bed.substeps         = 20;
    bed.settling         = 0.1;
    bed.free             = 0.06;
    const auto supported = test::watch_sphere(this->exec(), bed);
    test::report("creep at 0.15 W, supported, mm/s", supported.creep / mm, 0, 0.2,
                 "0.1 in docs/verification.md#points-during-the-substeps, and a swing");
    EXPECT_LT(std::abs(supported.creep), 0.2 * mm);
    test::report("what friction holds, over W", supported.pull, 0.15, 0.0015, "1 %: at rest");
    EXPECT_NEAR(supported.pull, 0.15, 0.0015);
}

/// What the choice of the grid's acceleration avoids.
TYPED_TEST(FullSizeSphereOnBed, CreepsWherePointsRecoilFreely)
{
    test::SphereOnBed bed;
    bed.sideways         = 0.15;
    bed.substeps         = 20;
    bed.motion           = "ballistic";
    bed.settling         = 0.05;
    bed.free             = 0.06;
    const auto ballistic = test::watch_sphere(this->exec(), bed);
    test::report("creep at 0.15 W, ballistic, mm/s", ballistic.creep / mm, 41, 20,
                 "at least half of docs/verification.md#points-during-the-substeps");
    EXPECT_GT(ballistic.creep, 20 * mm);
}

/// Pulled slowly, the sphere needs a force of friction times its weight, whatever the number of substeps.
TYPED_TEST(FullSizeSphereOnBed, DragIsThatOfOneSubstep)
{
    const auto drag = [&](int substeps)
    {
        test::SphereOnBed bed;
        bed.speed    = 0.1;
        bed.substeps = substeps;
        bed.settling = 0.08;
        bed.free     = 0.06;
        return test::watch_sphere(this->exec(), bed).pull;
    };
    const double one = drag(1), many = drag(20);
    test::report("drag at 0.1 m/s over W, N = 1", one, 0.3, 0.006, "2 % of mu W, the sphere's swing");
    test::report("drag, N = 20 over N = 1", many / one, 1, 0.02, "docs/verification.md#points-during-the-substeps");
    EXPECT_NEAR(one, 0.3, 0.006);
    EXPECT_NEAR(many / one, 1, 0.02);
}

/// docs/verification.md#torque-without-friction: without friction the only torque about the axle of a body of
/// revolution comes from the sampled distance field (there is no analytic one), between whose nodes the gradient misses
/// the axle by as much as h/R: 1.2 degrees at 80 cells (docs/verification.md#distance-fields). It does so to either
/// side, so that the torque averages out as the body turns.
template<class Exec>
void expect_no_torque(const Exec& exec, const std::string& form)
{
    constexpr int     cells = 96;
    test::SphereOnBed bed;
    bed.form        = form;
    bed.friction    = 0;
    bed.substeps    = 1;
    bed.settling    = 0.06;
    bed.free        = 0.05;
    bed.spin        = 5;
    bed.sdf_cells   = cells;
    const auto body = test::watch_sphere(exec, bed);
    const auto what = fmt::format("torque over W r, {} cells, {}", cells, form.substr(0, 15));
    const auto most = 1.2 * std::numbers::pi / 180 * 80 / cells;
    test::report(what + ", mean", body.torque, 0, 5e-3, "docs/verification.md#torque-without-friction");
    EXPECT_LT(std::abs(body.torque), 5e-3);
    if (form == test::drum) { return; } // its facets are visible in single steps
    test::report(what + ", largest of a step", body.most_torque, 0, most,
                 "docs/verification.md#distance-fields: the largest error of the normals");
    EXPECT_LT(body.most_torque, most);
}

TYPED_TEST(FullSizeSphereOnBed, FrictionlessBodyOfRevolutionFeelsNoTorque)
{
    expect_no_torque(this->exec(), "kind = \"sphere\"");
}

TYPED_TEST(FullSizeSphereOnBed, FrictionlessDrumFeelsNoTorque) { expect_no_torque(this->exec(), test::drum); }

} // namespace
