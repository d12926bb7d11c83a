#include "contact_places.hpp"

#include <cstdio>

// Contacts over many substeps and several steps.
namespace tread::test
{
namespace
{

template<class Case>
class ContactKept : public ContactTest<Case>
{
};

TYPED_TEST_SUITE(ContactKept, ContactCases, ContactCaseNames);

/// A point displaced between two bodies oscillates as on two springs of Hertz's stiffness (closed form), with equal and
/// opposite impulses on the bodies; a frozen point does not move and records its restoring impulse.
TYPED_TEST(ContactKept, PointBetweenTwoBodiesSwingsAsOnTwoSprings)
{
    using contact::PointMotion;
    const double overlap = 1e-4, aside = 5e-6;
    const double stiffness = 2 * 2e6 * std::sqrt(radius * overlap); // of both, E* = 1e6 Pa
    const double mass      = static_cast<double>(static_cast<typename TypeParam::Real>(SceneNumbers{}.mass));
    const double period    = 2 * 3.14159265358979323846 * std::sqrt(mass / stiffness);
    BodyState    above     = slab_below();
    above.position[2] += 0.04 + 2 * (radius - overlap);
    const Vec3<double> middle = point_over_slab(overlap);
    for (const PointMotion motion : {PointMotion::supported, PointMotion::ballistic, PointMotion::frozen})
    {
        SceneNumbers numbers;
        numbers.motion        = motion;
        numbers.pair.friction = 0;
        numbers.point_speed   = 0;
        typename TestFixture::Scene scene(this->exec(), {slab()}, {slab_below(), above},
                                          {{middle + Vec3<double>(0, 0, aside)}}, numbers);
        const bool                  frozen = motion == PointMotion::frozen;
        constexpr int               steps  = 1000;
        const double                dt     = period / steps;
        const auto                  height = [&] { return (scene.contact.position.to_host()[0] - middle)[2] / aside; };
        Vec3<double>                given  = Vec3<double>::Zero();
        scene.begin();
        for (int i = 0; i < steps; ++i)
        {
            scene.substep(dt);
            for (const Vec3<double>& force : scene.bodies.force.to_host()) { given += dt * force; }
            if (i == 0)
            {
                const double push = scene.bodies.force.to_host()[0][2] + scene.bodies.force.to_host()[1][2];
                std::printf("push on both %.6e N, closed form %.6e, tolerance 1 %% (field in fp32, overlap^1.5)\n",
                            push, stiffness * aside);
                EXPECT_NEAR(push, stiffness * aside, 0.01 * stiffness * aside);
            }
            if (i == steps / 2 - 1)
            {
                std::printf("after half a period at %.5f of where it began, expected %d, tolerance 1 %%\n", height(),
                            frozen ? 1 : -1);
                EXPECT_NEAR(height(), frozen ? 1 : -1, 0.01);
            }
        }
        const double impulse = stiffness * aside * period; // if it were held aside
        std::printf("after a period at %.5f, expected 1, tolerance 1 %%; bodies and point apart by %.1e N s of %.1e\n",
                    height(), (given + scene.contact.impulse.to_host()[0]).norm(), impulse);
        EXPECT_NEAR(height(), 1, 0.01);
        EXPECT_NEAR(given[2] / impulse, frozen ? 1 : 0, 0.01);
        EXPECT_LE((given + scene.contact.impulse.to_host()[0]).norm(), 1e-12 * impulse + 1e-16 * steps);
        const double elastic = 2 * 8.0 / 15.0 * 1e6 * std::sqrt(radius) * std::pow(overlap, 2.5);
        const double stored  = elastic + 0.5 * stiffness * aside * aside;
        EXPECT_NEAR(scene.summary().energy, stored, 1e-3 * stored) << "nothing was lost in a period";
        EXPECT_EQ(scene.summary().live, 2);
    }
}

/// Steps with a reused list equal those with a search in each: same forces, same friction, same energy balance.
TYPED_TEST(ContactKept, KeptCandidatesChangeNothing)
{
    using Real = typename TypeParam::Real;
    SceneNumbers numbers;
    numbers.skin = 0.5 * radius;
    typename TestFixture::Scene kept(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(2000), numbers);
    typename TestFixture::Scene searched(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(2000));
    double                      lost[2] = {0, 0};
    for (int step = 0; step < 5; ++step)
    {
        if (step == 0) { kept.begin(); }
        else { kept.begin_kept(); }
        searched.begin();
        for (auto* scene : {&kept, &searched})
        {
            for (int i = 0; i < 4; ++i) { scene->substep(2.5e-5); }
            scene->finish();
            auto at = scene->bodies.position.to_host();
            at[0] += 1e-4 * ball().velocity;
            scene->bodies.position.assign(at);
            lost[scene == &searched] += scene->summary().dissipated;
        }
    }
    const auto   forces = kept.contact_forces(), expected = searched.contact_forces();
    const double limit   = sizeof(Real) == 4 ? 1e-6 : 1e-12;
    double       largest = 0, apart = 0;
    for (std::size_t p = 0; p < forces.size(); ++p)
    {
        largest = std::max(largest, expected[p].norm());
        apart   = std::max(apart, (forces[p] - expected[p]).norm());
    }
    std::printf("[ measured ] forces on points apart by %.1e of the largest, tolerance %.0e (rounding); friction took "
                "%.6e and %.6e J\n",
                apart / largest, limit, lost[0], lost[1]);
    EXPECT_GT(largest, 0);
    EXPECT_LE(apart, limit * largest);
    EXPECT_GT(lost[0], 0);
    EXPECT_NEAR(lost[0], lost[1], 1e-12 * lost[1]);
    const auto records = kept.records(), others = searched.records();
    ASSERT_EQ(records.size(), others.size());
    for (std::size_t r = 0; r < records.size(); ++r) { EXPECT_EQ(records[r].key, others[r].key); }
}

/// Another body gets a row before that of the touched one: forces, which body is meant and its number stay.
TYPED_TEST(ContactKept, FollowsRowsThatComeWithinAStep)
{
    using Scene = typename TestFixture::Scene;
    Scene stays(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(300));
    Scene first(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(300));
    Scene more(this->exec(), {sphere_shape(0.05, 40)}, {{{0.1, 0.1, 0.1}}, ball()}, skin(300));
    first.bodies.number.assign({7});
    more.bodies.number.assign({3, 7});
    for (Scene* scene : {&stays, &first})
    {
        scene->begin();
        scene->substep(5e-5);
    }
    more.contact = std::move(first.contact);
    Array<typename TypeParam::Exec, std::int32_t> row(this->exec(), "rows");
    row.assign({1});
    contact::follow_rows(this->exec(), more.contact, row, more.bodies.view());
    stays.substep(5e-5);
    more.substep(5e-5);
    EXPECT_EQ(more.bodies.force.to_host()[0], Vec3<double>(Vec3<double>::Zero()));
    EXPECT_EQ(more.bodies.force.to_host()[1], stays.bodies.force.to_host()[0]);
    EXPECT_GT(stays.bodies.force.to_host()[0].norm(), 0);
    EXPECT_EQ(more.summary().deepest.body, 7);
    const auto records = more.records(), others = stays.records();
    ASSERT_EQ(records.size(), others.size());
    for (std::size_t r = 0; r < records.size(); ++r)
    {
        EXPECT_EQ(contact::body_of(records[r].key), 7);
        EXPECT_EQ(contact::point_of(records[r].key), contact::point_of(others[r].key));
    }
}

} // namespace
} // namespace tread::test
