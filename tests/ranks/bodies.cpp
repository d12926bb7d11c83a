#include <cstdio>
#include <set>

#include "physics/joint_scenes.hpp"
#include "physics/rock_scenes.hpp"
#include "side_by_side.hpp"

// Rocks and wheels on several ranks agree with a run on one rank.
namespace tread
{
namespace
{

template<class Exec>
class BodiesOfRanks : public test::BackendTest<Exec>
{
protected:
    static int ranks() { return test::world().size(); }
};
TYPED_TEST_SUITE(BodiesOfRanks, test::Backends, test::BackendNames);

constexpr double stone_young = 1e7;

std::string clast(int nodes)
{
    return fmt::format(R"(
[[shape]]
name      = "clast"
generate  = {{ kind = "rock", seed = 3, aspect = 0.7, sphericity = 0.9, nodes = {} }}
sdf_cells = 24
)",
                       nodes);
}

std::string ball()
{
    return R"(
[[shape]]
name      = "clast"
generate  = { kind = "sphere", nodes = 162 }
sdf_cells = 24
)";
}

std::string fixed_step(double dt) { return fmt::format("\n[time]\ndt = {}\n", dt); }

/// A rock of 4 cm that slides along x down a slope of 40 degrees with friction 0.5, from the first rank to the last.
TYPED_TEST(BodiesOfRanks, ARockSlidesOverTheirBorder)
{
    const Vec3<double> size(0.4, 0.2, 0.2);
    const std::string  text = test::rock_domain(size, 40,
                                                "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", "") +
                             test::stone(stone_young, 0.5, 0.5) + clast(642) + R"(
[[body]]
name = "slider"
shape = "clast"
material = "stone"
density = 2700.0
diameter = 0.04
position = [0.17, 0.1, 0.021]
velocity = [0.8, 0.0, 0.0]
lock = ["roll", "pitch", "yaw"]
)" + fixed_step(2e-4) + test::phase("slide", 0, 1);
    const auto border = [last = this->ranks() - 1](const Vec3<double>& at) { return at[0] < 0.18 ? 0 : last; };
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size, border);
    const Vec3<double>          start   = run.alone.simulation().named_bodies().front().position;
    double                      largest = 0, force = 0;
    for (int step = 0; step < 200; ++step)
    {
        run.advance();
        const solver::BodyRow one = run.alone.simulation().named_bodies().front(),
                              all = run.together.simulation().named_bodies().front();
        force                     = std::max(force, one.force.norm());
        largest =
            std::max({largest, (one.position - all.position).norm() / 0.04, (one.velocity - all.velocity).norm()});
        largest = std::max(largest, (one.force - all.force).norm() / std::max(one.force.norm(), 1e-3));
        run.alone.simulation().begin_mean();
        run.together.simulation().begin_mean();
    }
    std::printf("sliding rock: largest difference %.3g, largest force %.3g N\n", largest, force);
    EXPECT_LT(largest, 1e-9);
    if (this->ranks() > 1)
    {
        EXPECT_NE(run.owner_of(start), run.owner_of(run.alone.simulation().named_bodies().front().position));
    }
}

/// A rock of 4 cm towed along x over a floor from the first rank to the last, with a torque, a carriage and a load.
TYPED_TEST(BodiesOfRanks, ATowedRockCrossesTheirBorder)
{
    const Vec3<double> size(0.4, 0.2, 0.2);
    const std::string  text = test::rock_domain(size, 0,
                                                "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", "") +
                             test::stone(stone_young, 0.5, 0.5) + clast(642) + R"(
[[body]]
name = "towed"
shape = "clast"
material = "stone"
density = 2700.0
diameter = 0.04
position = [0.14, 0.1, 0.021]
)" + fixed_step(2e-4) + R"(
[[phase]]
name = "tow"
duration = 1
[[phase.motion]]
body          = "towed"
frame         = "body"
rotation_frame = "body"
x             = { velocity = 2.0, ramp = 0.02 }
y             = "held"
yaw           = "held"
axle          = { torque = 1.0e-3, ramp = 0.01 }
axle_friction = 1.0e-4
load          = 2.0
carriage      = { stiffness = 50.0, damping = 0.5, height = 0.03 }
)";
    const auto border = [last = this->ranks() - 1](const Vec3<double>& at) { return at[0] < 0.18 ? 0 : last; };
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size, border);
    const Vec3<double>          start   = run.alone.simulation().named_bodies().front().position;
    double                      largest = 0, pull = 0;
    for (int step = 0; step < 300; ++step)
    {
        run.advance();
        const solver::BodyRow one = run.alone.simulation().named_bodies().front(),
                              all = run.together.simulation().named_bodies().front();
        pull    = std::max(pull, one.reaction_force.norm()); // N; torques are of the order of its tenth and 2 cm
        largest = std::max({largest, (one.position - all.position).norm() / 0.04, (one.velocity - all.velocity).norm(),
                            (one.reaction_force - all.reaction_force).norm(),
                            100 * (one.reaction_torque - all.reaction_torque).norm()});
        run.alone.simulation().begin_mean();
        run.together.simulation().begin_mean();
    }
    std::printf("towed rock: largest difference %.3g, largest reaction %.3g N\n", largest, pull);
    EXPECT_LT(largest, 1e-8);
    EXPECT_GT(pull, 1);
    if (this->ranks() > 1)
    {
        EXPECT_NE(run.owner_of(start), run.owner_of(run.alone.simulation().named_bodies().front().position));
    }
}

/// A heap of 1,000 rocks that slumps along x under a tilted gravity of several g.
std::string heap(int rocks, const std::string& form)
{
    return R"(
title = "heap"
[domain]
size    = [0.4, 0.13, 0.2]
gravity = [60.0, 0.0, -40.0]
walls   = { x = "slip", y = "slip", bottom = "fixed", top = "open" }
)" + test::stone(stone_young, 0.5, 0.5) +
           form +
           fmt::format(R"(
[[rocks]]
shape = "clast"
material = "stone"
count = {}
diameter = 0.01
placement = "grid"
region = {{ box = [[0.0, 0.0, 0.0], [0.2, 0.13, 0.13]] }}
)",
                       rocks) +
           fixed_step(2e-4) + test::phase("slump", 0, 1);
}

std::string with_mass_scaling(const std::string& text, double factor)
{
    const std::string start = "[time]\n";
    std::string       scene = text;
    return scene.insert(scene.find(start) + start.size(), fmt::format("mass_scaling = {}\n", factor));
}

const Vec3<double> heap_size(0.4, 0.13, 0.2);

auto heap_slabs(int parts) { return test::slabs(heap_size[0], parts); }

/// Number of rocks whose position now belongs to another rank.
template<class Exec>
int migrated(const test::SideBySide<Exec>& run, const std::vector<double>& before, const std::vector<double>& after)
{
    const auto owner = [&](const std::vector<double>& at, std::size_t b)
    { return run.owner_of(Vec3<double>(at[3 * b], at[3 * b + 1], at[3 * b + 2])); };
    int moved = 0;
    for (std::size_t b = 0; 3 * b < before.size(); ++b) { moved += owner(before, b) != owner(after, b) ? 1 : 0; }
    return moved;
}

template<class Exec>
void expect_as_alone(test::SideBySide<Exec>& run, int steps, double diameter, double bound)
{
    for (int step = 0; step < steps; ++step)
    {
        run.advance();
        if (::testing::Test::HasFatalFailure()) { return; }
    }
    std::printf("%d ghosts have the bits of their owners\n", test::compare_holders(run.together.simulation().rigid()));
    const io::BodyFields one = run.alone.simulation().body_fields(), all = run.bodies_together();
    const double         places = test::difference(one.position, all.position, diameter),
                 speeds         = test::difference(one.velocity, all.velocity, 1.0),
                 turns          = test::difference(one.orientation, all.orientation, 1.0);
    std::printf("after %d steps: places differ by %.3g diameters, velocities by %.3g m/s, orientations by %.3g\n",
                steps, places, speeds, turns);
    EXPECT_LT(places, bound);
    EXPECT_LT(speeds, bound);
    EXPECT_LT(turns, bound);

    const solver::RigidCensus of_one = run.alone.simulation().census().rigid,
                              of_all = run.together.simulation().census().rigid;
    EXPECT_EQ(of_one.mass, of_all.mass);
    const double energy = std::abs(of_one.kinetic) + std::abs(of_one.gravity) + of_one.contact;
    EXPECT_NEAR(of_one.kinetic, of_all.kinetic, bound * energy);
    EXPECT_NEAR(of_one.contact, of_all.contact, bound * energy);
    EXPECT_NEAR(of_one.gravity, of_all.gravity, bound * energy);
    EXPECT_LT((of_one.momentum - of_all.momentum).norm(), bound * of_one.mass);
    const auto errors_of = [](auto& experiment) { return experiment.simulation().ledger().errors(); };
    EXPECT_NEAR(errors_of(run.alone).energy, errors_of(run.together).energy, bound);
    EXPECT_NEAR(errors_of(run.alone).momentum, errors_of(run.together).momentum, bound);
}

TYPED_TEST(BodiesOfRanks, AHeapOfRocksMigrates)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(heap(1000, ball())), heap_size,
                                    heap_slabs(this->ranks()));
    const auto                  before = run.bodies_together().position;
    expect_as_alone(run, 200, 0.01, 1e-8);
    const int moved  = migrated(run, before, run.bodies_together().position);
    const int ghosts = test::compare_holders(run.together.simulation().rigid());
    std::printf("%d of 1000 rocks changed their rank, %d ghosts are left\n", moved, ghosts);
    if (this->ranks() > 1)
    {
        EXPECT_GT(moved, 50);
        EXPECT_GT(ghosts, 50);
    }
}

/// The factors by which inertia is scaled are those of one rank, also of rocks that have come from others.
TYPED_TEST(BodiesOfRanks, AHeapMigratesWithItsScaledInertia)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(with_mass_scaling(heap(500, ball()), 9)), heap_size,
                                    heap_slabs(this->ranks()));
    const auto                  before = run.bodies_together().position;
    expect_as_alone(run, 150, 0.01, 1e-8);
    const auto energy = [](auto& experiment)
    { return experiment.simulation().ledger().energy(experiment.simulation().census()); };
    const solver::EnergyRow one = energy(run.alone), all = energy(run.together);
    std::printf("%d of 500 rocks changed their rank; scaled inertia took %.3g J, on ranks %.3g, of %.3g\n",
                migrated(run, before, run.bodies_together().position), one.mass_scaling, all.mass_scaling,
                one.kinetic_bodies);
    EXPECT_NEAR(one.mass_scaling, all.mass_scaling, 1e-8 * one.kinetic_bodies);
    EXPECT_GT(std::abs(one.mass_scaling), 1e-3 * one.kinetic_bodies) << "else hardly any inertia was scaled";
}

TYPED_TEST(BodiesOfRanks, ARankMayBeEmpty)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(heap(100, clast(162))), heap_size,
                                    heap_slabs(std::max(1, this->ranks() - 1)));
    expect_as_alone(run, 100, 0.01, 1e-8);
}

/// Ghosts are what reaches over a border: a band of two diameters each side, of a heap of twenty.
TYPED_TEST(BodiesOfRanks, ARankHasRowsForWhatItHolds)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(heap(1000, ball())), heap_size,
                                    test::slabs(0.5 * heap_size[0], this->ranks()));
    for (int step = 0; step < 20; ++step) { run.together.advance(); }
    const auto         rows = static_cast<std::int64_t>(run.together.simulation().rigid().numbers().rows());
    const std::int64_t all = test::world().sum(rows), most = test::world().maximum(rows);
    std::printf("1000 rocks have %d rows on all ranks, at most %d on one\n", static_cast<int>(all),
                static_cast<int>(most));
    EXPECT_GE(all, 1000);
    EXPECT_LE(all, 1000 + 250 * (this->ranks() - 1));
    if (this->ranks() > 1) { EXPECT_LT(most, 800); }
}

/// Their totals stay with the rank that has accounted for them, so that momentum balances.
TYPED_TEST(BodiesOfRanks, AllRocksOfARankMayLeave)
{
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(heap(100, ball())), heap_size,
                                    heap_slabs(this->ranks()));
    for (int step = 0; step < 900; ++step) { run.together.advance(); }
    const std::vector<double> position = run.bodies_together().position;
    const auto&               numbers  = run.together.simulation().rigid().numbers();
    if (this->ranks() > 1 && test::world().rank() == 0)
    {
        for (std::size_t b = 0; b < position.size(); b += 3) { ASSERT_NE(run.owner_of({position[b], 0.06, 0.01}), 0); }
        EXPECT_EQ(numbers.rows(), 1U) << "the first body, which has a row on every rank";
    }
    const double momentum = test::errors_of(run.together, run.together.simulation().census()).momentum;
    std::printf("momentum unaccounted for %.2g, tolerance 1e-10: sums of 100 bodies and 900 steps, rounded\n",
                momentum);
    EXPECT_LT(std::abs(momentum), 1e-10);
}

TYPED_TEST(BodiesOfRanks, TwoRunsGiveTheSameBits)
{
    io::BodyFields last;
    for (int pass = 0; pass < 2; ++pass)
    {
        test::SideBySide<TypeParam> run(this->exec(), test::load_text(heap(150, clast(162))), heap_size,
                                        heap_slabs(this->ranks()));
        for (int step = 0; step < 100; ++step) { run.together.advance(); }
        const io::BodyFields now = run.bodies_together();
        if (pass > 0)
        {
            EXPECT_EQ(now.position, last.position);
            EXPECT_EQ(now.orientation, last.orientation);
            EXPECT_EQ(now.velocity, last.velocity);
            EXPECT_EQ(now.angular_velocity, last.angular_velocity);
        }
        last = now;
    }
}

/// A wheel on a bed of rocks, above the corner of four ranks; it is dropped and rolls over the border in x.
TYPED_TEST(BodiesOfRanks, AWheelRollsOnTheCornerOfFour)
{
    const Vec3<double> size(0.4, 0.4, 0.4);
    const std::string  text = test::rock_domain(size, 0,
                                                "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"", "") +
                             test::stone(stone_young, 0.5, 0.5) + clast(162) + R"(
[[shape]]
name = "wheel"
generate = { kind = "wheel", radius = 0.1, width = 0.08, wall_thickness = 0.03, grousers = 9, grouser_height = 0.01, grouser_width = 0.01 }
node_spacing = 0.008
sdf_cells = 48
[[rocks]]
shape = "clast"
material = "stone"
count = 120
diameter = 0.024
placement = "grid"
region = { box = [[0.05, 0.05, 0.0], [0.35, 0.35, 0.05]] }
[[body]]
name = "wheel"
shape = "wheel"
material = "stone"
mass = 6.0
position = [0.2, 0.2, 0.145]
velocity = [0.0, 0.0, -0.6]
)" + fixed_step(2e-4) + R"(
[[phase]]
name = "drive"
duration = 1
drive = { body = "wheel", angular_velocity = 3.0, ramp = 0.02 }
)";
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size,
                                    test::quarters(0.5 * size, this->ranks()));
    expect_as_alone(run, 200, 0.024, 1e-8);
    const solver::BodyRow one = run.alone.simulation().named_bodies().front(),
                          all = run.together.simulation().named_bodies().front();
    std::printf("force on the wheel %.6g N, differs by %.3g\n", one.force.norm(), (one.force - all.force).norm());
    EXPECT_GT(one.force.norm(), 1) << "the wheel stands on rocks";
    EXPECT_LT((one.force - all.force).norm(), 1e-7 * one.force.norm());
    EXPECT_LT((one.torque - all.torque).norm(), 1e-7 * one.force.norm());
}

/// Advances both runs; expects the same places and forces of joints, of which some exceed `least` (N).
template<class Exec>
void expect_joints_as_alone(test::SideBySide<Exec>& run, double least)
{
    double largest = 0, force = 0, off = 0;
    for (int step = 0; step < 300; ++step)
    {
        run.advance();
        const auto one = run.alone.simulation().named_bodies(), all = run.together.simulation().named_bodies();
        for (std::size_t b = 0; b < one.size(); ++b)
        {
            largest = std::max(largest, (one[b].position - all[b].position).norm());
        }
        const auto joints = run.alone.simulation().joints(), others = run.together.simulation().joints();
        for (std::size_t j = 0; j < joints.size(); ++j)
        {
            force = std::max(force, joints[j].force.norm());
            off   = std::max(off, (joints[j].force - others[j].force).norm());
        }
        run.alone.simulation().begin_mean();
        run.together.simulation().begin_mean();
    }
    // a place that is off by rounding, 1e-16 m, takes 1e-16 m / dt^2 = 4e-7 N to put right in a substep of 5e-5 s
    std::printf("jointed bodies: largest distance %.3g m (tolerance 1e-12: rounding), forces up to %.3g N, off by %.3g "
                "(tolerance 1e-5: rounding of places)\n",
                largest, force, off);
    EXPECT_LT(largest, 1e-12);
    EXPECT_LT(off, 1e-5);
    EXPECT_GT(force, least);
}

/// The chain swings from the first rank's pages into the last one's; the joints are solved on every rank.
TYPED_TEST(BodiesOfRanks, JointedBodiesSwingOverTheirBorder)
{
    const Vec3<double> size(4, 1, 1);
    const auto         border = [last = this->ranks() - 1](const Vec3<double>& at) { return at[0] < 2.45 ? 0 : last; };
    // the first phase, which side by side does not end, must let go
    std::string       text = test::swinging_under_gravity(1.0);
    const std::string hold = "hold = [\"upper\", \"lower\", \"spun\"]\n";
    text.erase(text.find(hold), hold.size());
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size, border);
    expect_joints_as_alone(run, 100);
}

/// A motion on one rank leads a body whose weld ties it to one on another.
TYPED_TEST(BodiesOfRanks, AMotionLeadsAJointedBodyOverTheirBorder)
{
    const Vec3<double> size(4, 1, 1);
    const auto         border = [last = this->ranks() - 1](const Vec3<double>& at) { return at[0] < 1.1 ? 0 : last; };
    const std::string  text   = test::moved_text(1.0, "x = { velocity = 0.8, ramp = 0.1 }, z = \"held\", roll = "
                                                         "\"held\", yaw = \"held\"");
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size, border);
    expect_joints_as_alone(run, 50);
}

} // namespace
} // namespace tread
