#include <algorithm>
#include <set>
#include <vector>

#include "dem_bumpy.hpp"

// Bodies shared by two ranks, here in one process: each computes the pairs of the bodies that it owns.
namespace tread::test
{
namespace
{

template<class Exec>
class SharedBodies : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(SharedBodies, Backends, BackendNames);

constexpr std::int32_t count = heap_count;
constexpr double       dt    = 1e-5;

SolidNumbers stone()
{
    SolidNumbers numbers;
    numbers.friction = 0.4;
    numbers.zeta     = 0.2;
    numbers.gravity  = {0, 0, -9.8};
    numbers.planes   = {{{0, 0, 1}, 0.0, false}};
    return numbers;
}

/// One of two ranks: it owns every other body, and all others are ghosts.
template<class Exec, class Scene>
class Half
{
public:
    Half(const Exec& exec, const BumpyBody& bumpy, std::int32_t rank)
        : scene(exec, {bumpy.shape(162)}, bumpy_heap(bumpy), stone())
        , exec_(exec)
        , rank_(rank)
        , body_(exec, "test shared bodies")
        , first_(exec, "test shares")
        , row_(exec, "test rows")
        , wrench_(exec, "test wrenches", 2 * count)
        , stiffness_(exec, "test stiffnesses", 2 * count)
    {
        std::vector<std::int32_t> role, body, first{0}, row;
        for (std::int32_t b = 0; b < count; ++b)
        {
            role.push_back(b % 2 == rank ? dem::role_owner : dem::role_ghost);
            body.push_back(b);
            first.push_back(2 * (b + 1));
            const std::int32_t own = b, other = count + b;
            row.push_back(rank == 0 ? own : other);
            row.push_back(rank == 0 ? other : own);
        }
        scene.bodies.role.assign(role);
        body_.assign(body);
        first_.assign(first);
        row_.assign(row);
    }

    dem::SharedView shared()
    {
        return {count,       body_.data(),   body_.data(),      first_.data(),
                row_.data(), wrench_.data(), stiffness_.data(), nullptr};
    }

    /// Receives what would arrive by message.
    void receive(Half& other)
    {
        copy(exec_, wrench_.data() + count, other.wrench_.data(), count * sizeof(dem::WrenchShare));
        copy(exec_, stiffness_.data() + count, other.stiffness_.data(), count * sizeof(dem::StiffnessShare));
    }

    dem::BodyStep<Exec> step()
    {
        dem::BodyStep<Exec> one = scene.step(dt);
        one.shared              = shared();
        return one;
    }

    void contact()
    {
        evaluate_contacts(exec_, scene.pairs, scene.bodies.view(), scene.law(), dt);
        share_wrenches(exec_, step());
    }

    void expect()
    {
        expect_contacts(exec_, scene.pairs, scene.bodies.view(), scene.law(), scene.numbers.gravity, dt, shared());
    }

    Scene scene;

private:
    Exec                             exec_;
    std::int32_t                     rank_;
    Array<Exec, std::int32_t>        body_;
    Array<Exec, std::int32_t>        first_;
    Array<Exec, std::int32_t>        row_;
    Array<Exec, dem::WrenchShare>    wrench_;
    Array<Exec, dem::StiffnessShare> stiffness_;
};

double furthest(const std::vector<Vec3<double>>& one, const std::vector<Vec3<double>>& other)
{
    double largest = 0;
    for (std::size_t b = 0; b < one.size(); ++b) { largest = std::max(largest, (one[b] - other[b]).norm()); }
    return largest;
}

TYPED_TEST(SharedBodies, MoveAsThoseOfOneRank)
{
    using Whole = typename TestFixture::Scene;
    using Rank  = Half<TypeParam, Whole>;
    const BumpyBody bumpy(32);
    Whole           whole(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), stone());
    Rank            even(this->exec(), bumpy, 0), odd(this->exec(), bumpy, 1);
    whole.find(25 * dt);
    even.scene.find(25 * dt);
    odd.scene.find(25 * dt);

    std::vector<std::uint64_t> keys = even.scene.pairs.key.to_host(), others = odd.scene.pairs.key.to_host();
    EXPECT_FALSE(keys.empty());
    EXPECT_FALSE(others.empty());
    keys.insert(keys.end(), others.begin(), others.end());
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(keys, whole.pairs.key.to_host()) << "every pair on one rank";

    for (int substep = 0; substep < 25; ++substep)
    {
        evaluate_contacts(this->exec(), whole.pairs, whole.bodies.view(), whole.law(), dt);
        whole.move(dt);
        even.contact();
        odd.contact();
        even.receive(odd);
        odd.receive(even);
        move_bodies(this->exec(), even.step());
        move_bodies(this->exec(), odd.step());
    }
    EXPECT_EQ(even.scene.bodies.position.to_host(), odd.scene.bodies.position.to_host());
    EXPECT_EQ(even.scene.bodies.velocity.to_host(), odd.scene.bodies.velocity.to_host());
    EXPECT_EQ(even.scene.bodies.angular_velocity.to_host(), odd.scene.bodies.angular_velocity.to_host());
    const auto turned = [](const Quat& q) { return q.coeffs(); };
    EXPECT_EQ(turned(even.scene.bodies.orientation.to_host()[3]), turned(odd.scene.bodies.orientation.to_host()[3]));
    // Sums of some ten forces of 1 kN in another order.
    EXPECT_LT(furthest(even.scene.bodies.force.to_host(), whole.bodies.force.to_host()), 1e-9);
    EXPECT_LT(furthest(even.scene.bodies.velocity.to_host(), whole.bodies.velocity.to_host()), 1e-12);

    const dem::BodySums all = whole.sums(), one = even.scene.sums(), other = odd.scene.sums();
    EXPECT_NEAR(one.kinetic + other.kinetic, all.kinetic, 1e-12 * all.kinetic);
    EXPECT_NEAR(one.contact + other.contact, all.contact, 1e-12 * all.contact);
    EXPECT_NEAR(one.total.friction + other.total.friction, all.total.friction, 1e-12 * all.total.friction);
    EXPECT_NEAR(one.total.restitution + other.total.restitution, all.total.restitution, 1e-9 * all.total.restitution);
    EXPECT_LT((one.total.wall_impulse + other.total.wall_impulse - all.total.wall_impulse).norm(),
              1e-12 * all.total.wall_impulse.norm());
}

TYPED_TEST(SharedBodies, ExpectTheContactsOfAllRanks)
{
    using Whole = typename TestFixture::Scene;
    using Rank  = Half<TypeParam, Whole>;
    const BumpyBody bumpy(32);
    Whole           whole(this->exec(), {bumpy.shape(162)}, bumpy_heap(bumpy), stone());
    Rank            even(this->exec(), bumpy, 0), odd(this->exec(), bumpy, 1);
    whole.find(dt);
    even.scene.find(dt);
    odd.scene.find(dt);
    expect_contacts(this->exec(), whole.pairs, whole.bodies.view(), whole.law(), whole.numbers.gravity, dt);
    even.expect();
    odd.expect();
    even.receive(odd);
    expect_shared_contacts(this->exec(), even.scene.pairs, even.shared());
    const auto expected = whole.pairs.expected_stiffness.to_host(),
               found    = even.scene.pairs.expected_stiffness.to_host();
    for (std::size_t b = 0; b < expected.size(); ++b)
    {
        EXPECT_GT(expected[b], 0);
        EXPECT_NEAR(found[b], expected[b], 1e-12 * expected[b]);
    }
}

} // namespace
} // namespace tread::test
