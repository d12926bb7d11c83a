#include <algorithm>
#include <vector>

#include "dem_bumpy.hpp"
#include "kernels/dem/motion/substeps.hpp"

// Substeps in one launch without the host, for few bodies, equal substeps launched one by one.
namespace tread::test
{
namespace
{

template<class Exec>
class Substeps : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(Substeps, Backends, BackendNames);

TYPED_TEST(Substeps, AreTheSameInOneCall)
{
    constexpr double dt    = 1e-5;
    constexpr int    count = 25;
    const BumpyBody  bumpy(32);
    SolidNumbers     numbers;
    numbers.friction = 0.4;
    numbers.zeta     = 0.2;
    numbers.gravity  = {0, 0, -9.8};
    numbers.planes   = {{{0, 0, 1}, 0.0, false}};
    typename TestFixture::Scene one(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), numbers);
    typename TestFixture::Scene other(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), numbers);
    one.run(dt, count, count);
    other.find(dt * count);
    run_substeps(this->exec(), other.step(dt), count);
    const auto stiffness = one.pairs.answers.stiffness.to_host();
    EXPECT_GT(std::count_if(stiffness.begin(), stiffness.end(), [](double value) { return value > 0; }), 8);
    EXPECT_EQ(other.bodies.position.to_host(), one.bodies.position.to_host());
    EXPECT_EQ(other.bodies.velocity.to_host(), one.bodies.velocity.to_host());
    EXPECT_EQ(other.bodies.angular_velocity.to_host(), one.bodies.angular_velocity.to_host());
}

} // namespace
} // namespace tread::test
