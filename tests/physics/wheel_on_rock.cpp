#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "energy_balance.hpp"
#include "rock_scenes.hpp"

// A wheel that straddles a rock, between two of its grousers.
namespace tread
{
namespace
{

template<class Exec>
class WheelOnRock : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(WheelOnRock, test::Backends, test::BackendNames);

constexpr double mass = 10; // kg

/// Grousers 3 cm high and 10 cm apart at their tips, over a fixed rock of 16 cm whose top reaches between the lowest
/// two. Locks keep the wheel upright, as an axle would; only the contact prevents it from rolling or sliding off.
std::string astride(const std::string& material, const std::string& numerics = "")
{
    return test::rock_domain({1, 1, 1}, 0, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", numerics) +
           material +
           fmt::format(R"(
[[shape]]
name = "wheel"
generate = {{ kind = "wheel", radius = 0.23, width = 0.1, wall_thickness = 0.03, grousers = 13, grouser_height = 0.03, grouser_width = 0.02 }}
node_spacing = 0.006
sdf_cells = 72
[[shape]]
name = "rock"
generate = {{ kind = "sphere", nodes = 2562 }}
sdf_cells = 48
[[body]]
name = "wheel"
shape = "wheel"
mass = {}
material = "stone"
position = [0.5, 0.5, 0.496]
lock = ["roll", "yaw"]
[[body]]
name = "rock"
shape = "rock"
diameter = 0.16
density = 2700.0
material = "stone"
position = [0.5, 0.5, 0.2]
)",
                       mass);
}

/// Normals of the patches between wheel and rock, pointing to the wheel.
template<class Experiment>
std::vector<Vec3<double>> patches(Experiment& run)
{
    std::vector<Vec3<double>> found;
    for (const world::ContactRecord& contact : run.simulation().contacts())
    {
        if (dem::second_of(contact.key) == 1) { found.push_back(contact.patch.normal); }
    }
    return found;
}

constexpr const char* held = "hold = [\"rock\"]\n";

/// Two grousers press the rock from two sides. The motion of the wheel, damped by its contacts only, is judged as for
/// rocks at rest (rock_rest.hpp), with the rock's radius as R. It rocks slowly about the rock on the springs of its two
/// contacts against its weight: hence the stiff material with low restitution.
TYPED_TEST(WheelOnRock, RestsBetweenTwoGrousers)
{
    constexpr double            settled = 0.5, free = 0.6, rock_radius = 0.08;
    test::Experiment<TypeParam> run(this->exec(), astride(test::stone(3e8, 0.5, 0.1)) +
                                                      test::phase("settle", 0.5, settled) + held +
                                                      test::phase("rest", 0, free) + held);
    Vec3<double>                start = Vec3<double>::Zero();
    double                      way = 0, spin = 0, kinetic = 0;
    const double                longest = 1e-2 * free / 2;
    run.run(
        [&](double time)
        {
            const solver::BodyRow wheel = run.simulation().named_bodies()[0];
            if (time < settled) { start = wheel.position; }
            else { way = std::max(way, (wheel.position - start).norm() / rock_radius); }
            if (time < settled + 0.5 * free) { return; }
            spin    = std::max(spin, wheel.angular_velocity.norm());
            kinetic = std::max(kinetic, run.simulation().census().rigid.kinetic / (mass * test::earth * rock_radius));
        });
    const std::vector<Vec3<double>> normals = patches(run);
    for (const Vec3<double>& normal : normals)
    {
        std::printf("patch that presses towards (%.3f, %.3f, %.3f)\n", normal[0], normal[1], normal[2]);
    }
    ASSERT_GE(normals.size(), 2);
    const auto along = [](const Vec3<double>& a, const Vec3<double>& b) { return a[0] < b[0]; };
    EXPECT_LT((*std::min_element(normals.begin(), normals.end(), along))[0], -0.1);
    EXPECT_GT((*std::max_element(normals.begin(), normals.end(), along))[0], 0.1);
    test::report("kinetic energy over m g R", kinetic, 0, 1e-8, "as of rocks at rest");
    test::report("longest way over R", way, 0, longest, "1e-2 in 2 s");
    test::report("largest spin in rad/s", spin, 0, 1e-2, "as of rocks at rest");
    EXPECT_LT(kinetic, 1e-8);
    EXPECT_LT(way, longest);
    EXPECT_LT(spin, 1e-2);
}

/// The energy balance of a landing on both grousers is of first order in the step; unaccounted losses of the two
/// patches would remain in the limit.
TYPED_TEST(WheelOnRock, LandingClosesTheBalance)
{
    const auto unaccounted = [&](double dt)
    {
        test::Experiment<TypeParam> run(
            this->exec(), astride(test::stone(1e7, 0.5, 0.5), fmt::format("[time]\ndt = {}\nsubsteps = 1\n", dt)) +
                              test::phase("land", 0, 0.1) + held);
        std::size_t most = 0;
        run.run([&](double) { most = std::max(most, patches(run).size()); });
        EXPECT_GE(most, 2);
        run.simulation().ledger().energy(run.simulation().census());
        return run.simulation().ledger().errors().energy;
    };
    const double coarse = unaccounted(1e-4), fine = unaccounted(5e-5), limit = 2 * fine - coarse;
    std::printf("unaccounted over the largest energy: %.2e at 0.1 ms, %.2e at 0.05 ms\n", coarse, fine);
    test::report("in the limit", limit, 0, test::closes, "design, section 7");
    EXPECT_LT(std::abs(limit), test::closes);
}

} // namespace
} // namespace tread
