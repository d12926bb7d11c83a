#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "dem_bumpy.hpp"
#include "kernels/dem/motion/substeps.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"

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

/// Substeps of a scene that end where a body has moved too far from where it is now.
template<class Exec>
class LimitedSubsteps
{
public:
    LimitedSubsteps(const Exec& exec, SolidScene<Exec>& scene)
        : exec_(exec)
        , scene_(scene)
        , places_(exec)
        , allowed_(exec, "test displacement allowed")
        , reached_(exec, "test substeps until a limit", 1)
    {
        mark_places(exec_, places_, scene_.bodies.view());
        allow(std::vector<double>(static_cast<std::size_t>(scene_.bodies.position.size()), 1));
    }

    /// m, of each body.
    void allow(const std::vector<double>& displacements) { allowed_.assign(displacements); }

    /// m, of each body.
    std::vector<double> displacements()
    {
        largest_displacement(exec_, places_, scene_.bodies.view(), scene_.law().templates, allowed_.data());
        std::vector<double> found = places_.share.to_host();
        found.pop_back();
        return found;
    }

    /// Requests substeps; returns after how many a body was beyond its limit, 0 = none was.
    std::int32_t run(double dt, int count)
    {
        reached_.fill_zero();
        auto step  = scene_.step(dt);
        step.limit = {places_.position.data(), places_.orientation.data(), allowed_.data(), scene_.law().templates,
                      reached_.data()};
        Exec until = exec_;
        until.skip = reached_.data();
        run_substeps(until, step, count);
        return read(exec_, reached_.data());
    }

private:
    const Exec&                    exec_;
    SolidScene<Exec>&              scene_;
    dem::DisplacementTracker<Exec> places_;
    Array<Exec, double>            allowed_;
    Array<Exec, std::int32_t>      reached_;
};

/// Requests more substeps than body `b` can do within its limit, which it leaves with the 11th; `one` and `other` are
/// alike. The limit lies half way between its displacements after 10 and after 11.
template<class Exec>
void expect_an_end(const Exec& exec, SolidScene<Exec>& one, SolidScene<Exec>& other, std::size_t b)
{
    constexpr double dt = 1e-5;
    one.find(dt * 30);
    other.find(dt * 30);
    LimitedSubsteps<Exec> free(exec, one), held(exec, other);
    ASSERT_EQ(free.run(dt, 10), 0) << "a metre is far";
    const double ten = free.displacements()[b];
    ASSERT_EQ(free.run(dt, 1), 0);
    const double        eleven = free.displacements()[b];
    std::vector<double> limits(free.displacements().size(), 1.0);
    limits[b] = (ten + eleven) / 2;
    held.allow(limits);
    const std::int32_t reached = held.run(dt, 25);
    std::printf("body %zu has moved %.6e m after 10, %.6e after 11 substeps: ended after %d, expected 11, exact\n", b,
                ten, eleven, reached);
    EXPECT_EQ(reached, 11);
    EXPECT_EQ(other.bodies.position.to_host(), one.bodies.position.to_host());
    EXPECT_EQ(other.bodies.velocity.to_host(), one.bodies.velocity.to_host());
    EXPECT_EQ(other.totals.to_host()[b].friction, one.totals.to_host()[b].friction);
}

TYPED_TEST(Substeps, EndWithTheOneThatMovesABodyTooFar)
{
    const BumpyBody bumpy(32);
    SolidNumbers    numbers;
    numbers.friction = 0.4;
    numbers.gravity  = {0, 0, -9.8};
    numbers.planes   = {{{0, 0, 1}, 0.0, false}};
    typename TestFixture::Scene one(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), numbers);
    typename TestFixture::Scene other(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), numbers);
    expect_an_end(this->exec(), one, other, 3);
}

/// Without pairs a substep is a motion only, and on a GPU a launch of its own.
TYPED_TEST(Substeps, EndInFreeFlight)
{
    SolidNumbers numbers;
    numbers.gravity                   = {0, 0, -9.8};
    const std::vector<Solid>    apart = {solid_sphere(0.1, 2000, {0, 0, 0}), solid_sphere(0.1, 2000, {5, 0, 0})};
    typename TestFixture::Scene one(this->exec(), {unit_sphere(2, 24)}, apart, numbers);
    typename TestFixture::Scene other(this->exec(), {unit_sphere(2, 24)}, apart, numbers);
    expect_an_end(this->exec(), one, other, 1);
}

/// A body at no finite place leaves its limit at once.
TYPED_TEST(Substeps, EndWhereABodyIsNowhere)
{
    std::vector<Solid> lost = {solid_sphere(0.1, 2000, {0, 0, 0}), solid_sphere(0.1, 2000, {5, 0, 0})};
    lost[1].velocity        = {0, std::nan(""), 0};
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(2, 24)}, lost, {});
    scene.find(1e-4);
    LimitedSubsteps<TypeParam> limited(this->exec(), scene);
    EXPECT_EQ(limited.run(1e-5, 5), 1);
}

} // namespace
} // namespace tread::test
