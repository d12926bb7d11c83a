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

constexpr double       short_step = 1e-5; ///< s, of a substep
constexpr std::int32_t of_step    = 40;   ///< substeps of a step

/// A list of pairs that allows a displacement of this size (m), with looks after every batch of substeps.
template<class Exec>
class LimitedList
{
public:
    LimitedList(const Exec& exec, SolidScene<Exec>& scene, std::int32_t batch, double allowed)
        : exec_(exec)
        , scene_(scene)
        , batch_(batch)
        , places_(exec)
        , allowed_(exec, "test displacement allowed")
        , numbers_(exec, "test substeps of a list", 2)
    {
        scene_.find(short_step * of_step);
        mark_places(exec_, places_, scene_.bodies.view());
        allowed_.assign(std::vector<double>(static_cast<std::size_t>(scene_.bodies.position.size()), allowed));
        numbers_.fill_zero();
    }

    /// Requests all substeps of a step, which look themselves; returns the last that was done, 0 = all.
    std::int32_t run()
    {
        auto step  = scene_.step(short_step);
        step.limit = {places_.listed({allowed_.data()}),
                      scene_.law().templates,
                      short_step,
                      batch_,
                      of_step,
                      numbers_.data(),
                      1,
                      numbers_.data() + 1};
        run_substeps(exec_, step, of_step);
        return read(exec_, numbers_.data());
    }

    /// Runs batches of substeps with a look of its own after each, which applies after the next; returns likewise.
    std::int32_t run_with_looks_between()
    {
        for (std::int32_t done = 0; done + batch_ < of_step;)
        {
            run_substeps(exec_, scene_.step(short_step), batch_);
            done += batch_;
            const double ahead = short_step * std::min(2 * batch_, of_step - done);
            const double share =
                read(exec_, largest_displacement_ahead(exec_, places_, scene_.bodies.view(), scene_.law().templates,
                                                       {allowed_.data()}, 0, {ahead, ahead}));
            if (!(share > 1) || done + batch_ >= of_step) { continue; }
            run_substeps(exec_, scene_.step(short_step), batch_);
            return done + batch_;
        }
        return 0;
    }

private:
    const Exec&                    exec_;
    SolidScene<Exec>&              scene_;
    std::int32_t                   batch_;
    dem::DisplacementTracker<Exec> places_;
    Array<Exec, double>            allowed_;
    Array<Exec, std::int32_t>      numbers_;
};

template<class Exec>
void expect_the_same_end(const Exec& exec, SolidScene<Exec>& one, SolidScene<Exec>& other, std::int32_t batch,
                         double allowed)
{
    const std::int32_t expected = LimitedList<Exec>(exec, one, batch, allowed).run_with_looks_between();
    const std::int32_t found    = LimitedList<Exec>(exec, other, batch, allowed).run();
    std::printf("looks after every %d substeps: ended after %d, expected %d, exact\n", batch, found, expected);
    EXPECT_GT(expected, batch);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(other.bodies.position.to_host(), one.bodies.position.to_host());
    EXPECT_EQ(other.bodies.velocity.to_host(), one.bodies.velocity.to_host());
}

TYPED_TEST(Substeps, EndWithTheLastThatTheirListServes)
{
    const BumpyBody bumpy(32);
    SolidNumbers    numbers;
    numbers.friction = 0.4;
    numbers.gravity  = {0, 0, -9.8};
    numbers.planes   = {{{0, 0, 1}, 0.0, false}};
    for (const std::int32_t batch : {1, 3})
    {
        typename TestFixture::Scene one(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), numbers);
        typename TestFixture::Scene other(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), numbers);
        expect_the_same_end(this->exec(), one, other, batch, 2e-4); // of which the reserve takes 1.5e-4
    }
}

/// Without pairs a substep is a motion only, and on a GPU a launch of its own.
TYPED_TEST(Substeps, EndInFreeFlight)
{
    SolidNumbers numbers;
    numbers.gravity          = {0, 0, -9.8};
    std::vector<Solid> apart = {solid_sphere(0.1, 2000, {0, 0, 0}), solid_sphere(0.1, 2000, {5, 0, 0})};
    apart[1].velocity        = {0, 1, 0};
    typename TestFixture::Scene one(this->exec(), {unit_sphere(2, 24)}, apart, numbers);
    typename TestFixture::Scene other(this->exec(), {unit_sphere(2, 24)}, apart, numbers);
    expect_the_same_end(this->exec(), one, other, 2, 4e-4);
}

/// A body at no finite place ends the batch.
TYPED_TEST(Substeps, EndWhereABodyIsNowhere)
{
    std::vector<Solid> lost = {solid_sphere(0.1, 2000, {0, 0, 0}), solid_sphere(0.1, 2000, {5, 0, 0})};
    lost[1].velocity        = {0, std::nan(""), 0};
    typename TestFixture::Scene scene(this->exec(), {unit_sphere(2, 24)}, lost, {});
    EXPECT_EQ(LimitedList<TypeParam>(this->exec(), scene, 1, 1.0).run(), 2);
}

} // namespace
} // namespace tread::test
