#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "dem_bumpy.hpp"
#include "kernels/dem/motion/subcycle_marks.hpp"

// Bodies whose contacts are too stiff for a substep move in parts of it (kernels/dem/motion/subcycle.hpp).
namespace tread::test
{
namespace
{

template<class Exec>
class Subcycles : public DemTest<Exec>
{
protected:
    using Scene = typename DemTest<Exec>::Scene;

    /// Runs `count` substeps of dt (s) in parts; the list must be found and the marks made.
    void run(Scene& scene, double dt, int count, std::int32_t parts)
    {
        for (int i = 0; i < count * parts; ++i)
        {
            dem::BodyStep<Exec> step = scene.step(dt);
            step.cycle               = scene.pairs.stiff.cycle(parts, i % parts);
            evaluate_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), dt, step.cycle);
            move_bodies(this->exec(), step);
        }
    }

    /// Finds the list for a time (s) and marks bodies with sqrt(m / K) below `shortest` (s).
    void mark(Scene& scene, double time, double shortest)
    {
        scene.find(time);
        expect_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), scene.numbers.gravity, 0);
        mark_stiff(this->exec(), scene.pairs, scene.bodies.view(), shortest, {});
    }

    static std::int32_t marked(const Array<Exec, std::int32_t>& marks)
    {
        const std::vector<std::int32_t> all = marks.to_host();
        return std::accumulate(all.begin(), all.end(), 0);
    }

    static void expect_alike(const Scene& one, const Scene& other)
    {
        EXPECT_EQ(one.bodies.position.to_host(), other.bodies.position.to_host());
        EXPECT_EQ(one.bodies.velocity.to_host(), other.bodies.velocity.to_host());
        EXPECT_EQ(one.bodies.angular_velocity.to_host(), other.bodies.angular_velocity.to_host());
    }
};
TYPED_TEST_SUITE(Subcycles, Backends, BackendNames);

SolidNumbers rough()
{
    SolidNumbers numbers;
    numbers.friction = 0.4;
    numbers.zeta     = 0.2;
    numbers.gravity  = {0, 0, -9.8};
    numbers.planes   = {{{0, 0, 1}, 0.0, false}};
    return numbers;
}

constexpr double long_substep = 4e-5; ///< s

/// To the bit: what is marked alone decides what a part does.
TYPED_TEST(Subcycles, AreShorterSubstepsWhereAllAreMarkedAndNothingWhereNoneIs)
{
    using Scene            = typename TestFixture::Scene;
    constexpr int    count = 20, parts = 4;
    constexpr double time = 4 * count * long_substep;
    const auto       ones = [](std::int64_t size) { return std::vector<std::int32_t>(size, 1); };
    const BumpyBody  bumpy(32);
    Scene            parted(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), rough()),
        shorter(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), rough()),
        unmarked(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), rough()),
        whole(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), rough());
    this->mark(parted, time, 0);
    parted.pairs.stiff.pair.assign(ones(parted.pairs.key.size()));
    parted.pairs.stiff.body.assign(ones(heap_count));
    this->run(parted, long_substep, count, parts);
    shorter.find(time);
    this->run(shorter, long_substep / parts, count * parts, 1);
    this->expect_alike(parted, shorter);

    this->mark(unmarked, time, 0);
    EXPECT_EQ(this->marked(unmarked.pairs.stiff.pair) + this->marked(unmarked.pairs.stiff.body), 0);
    this->run(unmarked, long_substep, count, parts);
    whole.find(time);
    this->run(whole, long_substep, count, 1);
    this->expect_alike(unmarked, whole);
    EXPECT_EQ(unmarked.bodies.force.to_host(), whole.bodies.force.to_host());
}

/// A hundredth of a body lies among seven others, all rough.
TYPED_TEST(Subcycles, ShareMomentumExactly)
{
    constexpr int   light = 3;
    const BumpyBody bumpy(32);
    SolidNumbers    numbers = rough();
    numbers.gravity.setZero();
    numbers.planes.clear();
    std::vector<Solid> solids = bumpy_heap(bumpy);
    solids[light].mass /= 100;
    solids[light].inertia /= 100;
    typename TestFixture::Scene scene(this->exec(), {bumpy.shape(162)}, solids, numbers);
    scene.find(0.01);
    scene.contact(0);
    expect_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), numbers.gravity, 0);
    const double shortest = smallest_contact_time(this->exec(), scene.pairs, scene.bodies.view());
    this->mark(scene, 0.01, 2 * shortest);
    const std::int32_t bodies = this->marked(scene.pairs.stiff.body), pairs = this->marked(scene.pairs.stiff.pair);
    EXPECT_GT(bodies, 1);
    EXPECT_LT(bodies, heap_count);
    EXPECT_LT(pairs, scene.pairs.key.size());
    const dem::BodySums start = scene.sums();
    this->run(scene, 1.6 * shortest, 40, 2);
    const dem::BodySums end      = scene.sums();
    const double        momentum = (end.momentum - start.momentum).norm(), spin = (end.spin - start.spin).norm();
    const double        moved = scene.bodies.mass.to_host()[0] * scene.bodies.velocity.to_host()[0].norm();
    std::printf("marked %d bodies, %d of %ld pairs; momentum changes by %.2g N s, angular momentum by %.2g N m s; "
                "tolerance 1e-12 of the momentum of a body, %.3g N s: rounding of some hundred sums\n",
                bodies, pairs, static_cast<long>(scene.pairs.key.size()), momentum, spin, moved);
    EXPECT_GT(moved, 0);
    EXPECT_LT(momentum, 1e-12 * moved);
    EXPECT_LT(spin, 1e-12 * moved);
}

/// A body's stiffness is that of its pairs and of sand: the latter is told apart from both.
TYPED_TEST(Subcycles, TellTheStiffnessOfSandApart)
{
    constexpr double                     sand = 3e4; // N/m
    constexpr std::int32_t               body = 5;
    const BumpyBody                      bumpy(32);
    typename TestFixture::Scene          scene(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), rough());
    Array<TypeParam, std::int32_t>       run(this->exec(), "test runs"), first(this->exec(), "test first parts");
    Array<TypeParam, dem::ContactWrench> part(this->exec(), "test parts");
    std::vector<std::int32_t>            runs(heap_count, -1);
    runs[body] = 0;
    run.assign(runs);
    first.assign(std::vector<std::int32_t>{0, 2});
    part.assign(
        std::vector<dem::ContactWrench>{{{0, 0, 1}, {0, 0, 0}, 2 * sand / 3}, {{0, 0, 1}, {0, 0, 0}, sand / 3}});
    scene.find(0.01);
    stage_bodies(this->exec(), scene.pairs, scene.bodies.view());
    evaluate_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), 1e-5);
    scene.move(1e-5, 0, {run.data(), first.data(), part.data()});
    scene.pairs.stiff.wanted = true;
    expect_contacts(this->exec(), scene.pairs, scene.bodies.view(), scene.law(), scene.numbers.gravity, 1e-5);
    const std::vector<double> all = scene.bodies.stiffness.to_host(), of_sand = scene.pairs.stiff.sand.to_host();
    for (std::int32_t b = 0; b < heap_count; ++b)
    {
        const auto row = static_cast<std::size_t>(b);
        EXPECT_GT(all[row], b == body ? 1.1 * sand : 0) << "pairs are stiff, too";
        EXPECT_NEAR(of_sand[row], b == body ? sand : 0, 1e-12 * all[row]) << "rounding of sums; body " << b;
    }
    const double mass = scene.bodies.mass.to_host()[body], time = std::sqrt(mass / sand);
    EXPECT_NEAR(smallest_sand_time(this->exec(), scene.pairs, scene.bodies.view()), time, 1e-9 * time);
}

} // namespace
} // namespace tread::test
