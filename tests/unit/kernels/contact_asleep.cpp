#include <algorithm>
#include <cstring>

#include "contact_places.hpp"
#include "kernels/contact/sleeping_contacts.hpp"

// Contacts of sand and bodies that both sleep: what they keep, and what returns.
namespace tread::test
{
namespace
{

template<class Case>
class ContactAsleep : public ContactTest<Case>
{
};

TYPED_TEST_SUITE(ContactAsleep, ContactCases, ContactCaseNames);

bool same_records(const std::vector<contact::HistoryRecord>& one, const std::vector<contact::HistoryRecord>& other)
{
    return one.size() == other.size() &&
           std::memcmp(static_cast<const void*>(one.data()), static_cast<const void*>(other.data()),
                       one.size() * sizeof(contact::HistoryRecord)) == 0;
}

/// A ball in a skin of points; half of them fall asleep with it, then all, and all wake. The ball is pressed by what
/// sleeps and what does not as before, and the records return to the bit.
TYPED_TEST(ContactAsleep, KeepsForcesAndReturnsRecords)
{
    using Exec = typename TypeParam::Exec;
    for (const double sampled_below : {0.0, 1.0})
    {
        SceneNumbers numbers;
        numbers.sampled_below = sampled_below;
        numbers.motion        = contact::PointMotion::frozen;
        typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(500), numbers);
        const Exec                  exec = this->exec();
        scene.begin();
        scene.substep(1e-5);
        scene.substep(0); // at rest
        const Vec3<double> force  = scene.bodies.force.to_host()[0];
        const double       energy = scene.summary().energy;
        scene.bodies.asleep.assign({1});

        contact::SleepingContacts<Exec> asleep(exec);
        Array<Exec, dem::ContactWrench> press(exec, "test press", 1);
        Array<Exec, std::int32_t>       loaded(exec, "test loads", 1);
        loaded.fill_zero();
        const auto records = static_cast<std::int64_t>(scene.records().size());
        // the points as they are stand for those that have just fallen asleep
        const auto points = scene.points.view();
        const auto half   = points.count / 2;
        contact::take_contacts(exec, scene.contact, asleep, points, half, scene.bodies.view(), scene.law(),
                               loaded.data());
        contact::sum_sleeping(exec, asleep, scene.bodies.view(), press);
        const auto some = asleep.key.size();
        std::printf("samples below %g m: %ld records, %ld asleep\n", sampled_below, static_cast<long>(records),
                    static_cast<long>(some));
        EXPECT_GT(some, 0);
        EXPECT_LT(some, records);

        mpm::PointsView<typename TypeParam::Real> first_half = points;
        first_half.count                                     = half;
        contact::take_contacts(exec, scene.contact, asleep, first_half, 0, scene.bodies.view(), scene.law(),
                               loaded.data());
        contact::sum_sleeping(exec, asleep, scene.bodies.view(), press);
        const Vec3<double> kept = press.to_host()[0].force;
        std::printf("force of all: measured %.9e, expected %.9e N, tolerance 1e-9 of it: sums in another order\n",
                    kept.norm(), force.norm());
        std::printf("energy: measured %.9e, expected %.9e J, tolerance 1e-9 of it\n", asleep.energy, energy);
        EXPECT_EQ(asleep.key.size(), records);
        EXPECT_LT((kept - force).norm(), 1e-9 * force.norm());
        EXPECT_NEAR(asleep.energy, energy, 1e-9 * energy);
        const auto keys = asleep.key.to_host();
        EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
        EXPECT_EQ(loaded.to_host()[0], 1);

        const auto before = scene.records();
        put_back(exec, scene.contact.history, {});
        scene.contact.tangential.resize(0);
        contact::return_contacts(exec, scene.contact, asleep, points, half);
        EXPECT_EQ(scene.contact.history.key.size(), some);
        EXPECT_EQ(asleep.key.size(), records - some);
        contact::return_contacts(exec, scene.contact, asleep, first_half, 0);
        EXPECT_EQ(asleep.key.size(), 0);
        EXPECT_TRUE(same_records(read_out(scene.contact.history), before));
        contact::sum_sleeping(exec, asleep, scene.bodies.view(), press);
        EXPECT_EQ(press.to_host()[0].force.norm(), 0);
        EXPECT_EQ(asleep.energy, 0);
    }
}

/// What a body presses that is awake stays with the steps.
TYPED_TEST(ContactAsleep, OfBodiesAwakeNothingIsTaken)
{
    using Exec = typename TypeParam::Exec;
    typename TestFixture::Scene scene(this->exec(), {sphere_shape(0.05, 40)}, {ball()}, skin(500));
    const Exec                  exec = this->exec();
    scene.begin();
    scene.substep(1e-5);
    scene.bodies.asleep.assign({0});
    contact::SleepingContacts<Exec> asleep(exec);
    Array<Exec, std::int32_t>       loaded(exec, "test loads", 1);
    loaded.fill_zero();
    EXPECT_EQ(contact::take_contacts(exec, scene.contact, asleep, scene.points.view(), 0, scene.bodies.view(),
                                     scene.law(), loaded.data()),
              0);
    EXPECT_EQ(asleep.key.size(), 0);
    EXPECT_EQ(loaded.to_host()[0], 0);
}

} // namespace
} // namespace tread::test
