#include <numbers>
#include <vector>

#include "dem_scene.hpp"
#include "kernels/dem/motion/substeps.hpp"

// A body that is much larger than the others, and touches hundreds of them.
namespace tread::test
{
namespace
{

template<class Exec>
class LargeBody : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(LargeBody, Backends, BackendNames);

constexpr int    around = 600;
constexpr double small  = 0.05; ///< m, beside a ball of 1 m

/// A spinning ball, and `around` small ones pressed into its lower half by up to a tenth of their radius, which do not
/// touch each other: points of a golden spiral are 0.1 m apart and more.
std::vector<Solid> ball_in_gravel()
{
    std::vector<Solid> solids{solid_sphere(1, 2000, Vec3<double>::Zero())};
    solids[0].spin = {0.3, 1.0, -0.5};
    for (int i = 0; i < around; ++i)
    {
        const double       angle = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
        const double       z = -(i + 0.5) / around, r = std::sqrt(1 - z * z);
        const Vec3<double> direction(r * std::cos(angle), r * std::sin(angle), z);
        const double       pressed = small * (0.02 + 0.08 * (i % 7) / 6.0);
        solids.push_back(solid_sphere(small, 2000, (1 + small - pressed) * direction));
    }
    return solids;
}

template<class Scene>
void expect_reaction(Scene& scene, const char* how)
{
    const auto   force = scene.bodies.force.to_host(), torque = scene.bodies.torque.to_host();
    const auto   place = scene.bodies.position.to_host();
    Vec3<double> sum = Vec3<double>::Zero(), moment = Vec3<double>::Zero();
    double       size    = 0;
    int          pressed = 0;
    for (std::size_t b = 1; b < force.size(); ++b)
    {
        sum += force[b];
        moment += torque[b] + (place[b] - place[0]).cross(force[b]);
        size += force[b].norm();
        pressed += force[b].norm() > 0 ? 1 : 0;
    }
    const double     off = (force[0] + sum).norm() / size, turned = (torque[0] + moment).norm() / size;
    constexpr double rounding = 1e-13; // 600 terms in another order, fp64
    std::printf(
        "[ measured ] %s: %d small ones press the ball; force off by %.1e, torque by %.1e m of the sum of forces, "
        "tolerance %.0e (rounding)\n",
        how, pressed, off, turned, rounding);
    EXPECT_EQ(pressed, around);
    EXPECT_GT(sum.norm(), 0.1 * size);
    EXPECT_GT(torque[0].norm(), 1e-3 * size);
    EXPECT_LE(off, rounding);
    EXPECT_LE(turned, rounding);
}

TYPED_TEST(LargeBody, FeelsAllThatItPresses)
{
    constexpr double dt = 1e-5;
    SolidNumbers     numbers;
    numbers.friction = 0.4;
    typename TestFixture::Scene scene(this->exec(), {exact_sphere()}, ball_in_gravel(), numbers);
    ASSERT_EQ(scene.pairs.sizes.large.size(), 1);
    scene.find(dt);
    scene.contact(dt);
    expect_reaction(scene, "kernel by kernel");
    run_substeps(this->exec(), scene.step(0), 1);
    expect_reaction(scene, "in one call");
}

} // namespace
} // namespace tread::test
