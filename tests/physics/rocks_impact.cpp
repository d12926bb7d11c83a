#include <algorithm>
#include <cmath>

#include "rock_scenes.hpp"

// Bodies against walls with automatic steps.
namespace
{

using namespace tread;

template<class Exec>
class RocksImpact : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(RocksImpact, test::Backends, test::BackendNames);

/// A slab of 40 kg, 0.5 m wide and stiff as metal, that drops flat on a rigid floor from `height` (m), sliding.
std::string flat_drop(const test::MeshFile& slab, double height)
{
    return test::rock_domain({1, 1, 1}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"", "") +
           test::stone(7e10, 0.3, 1.0) + test::file_shape("slab", slab, 0.02, 40) +
           fmt::format(R"(
[[body]]
name = "slab"
shape = "slab"
material = "stone"
mass = 40.0
position = [0.5, 0.5, {}]
velocity = [0.1, 0.0, -0.2]
)",
                       0.05 + height) +
           test::phase("drop", 0, 0.03);
}

/// All nodes of a face touch in the same substep, 600 times as stiff as the first touch of a corner: the step must be
/// chosen for this in advance. A step chosen from touching contacts gained 12 J when a wheel of 170 kg hit a wall with
/// its flank.
TYPED_TEST(RocksImpact, AFaceThatArrivesAtOnceGainsNoEnergy)
{
    const test::MeshFile slab(test::box_mesh({0.25, 0.25, 0.05}));
    for (const double height : {1e-4, 1e-3, 3e-3})
    {
        test::Experiment<TypeParam> drop(this->exec(), flat_drop(slab, height));
        drop.run();
        solver::Ledger& ledger = drop.simulation().ledger();
        ledger.energy(drop.simulation().census());
        const double error = ledger.errors().energy;
        const double up    = drop.simulation().named_bodies()[0].velocity[2];
        test::report(fmt::format("unaccounted over the largest energy, from {} m", height), error, 0, 0.02,
                     "the integrator keeps m v^2/2 + K x^2/2 - dt K x v/2: a face that comes or goes at any part of a "
                     "substep of 0.2 sqrt(m/K) finds up to 0.2^2/4 of it amiss, each time");
        EXPECT_LT(std::abs(error), 0.02);
        EXPECT_GT(up, -0.1) << "it should have met the floor";
    }
}

struct Rebound
{
    double speed = 0; ///< m/s, upwards, largest
    double force = 0; ///< N, largest at the end of any substep
};

/// A ball of 0.1 m, a mesh with some 640 nodes, that falls at 1 m/s on a floor, or on the face of a fixed slab whose
/// top is at `top`.
template<class Exec>
Rebound bounce(const Exec& exec, const std::string& slab, double top)
{
    shape::TriangleMesh ball = shape::icosphere(2562, "test");
    for (Eigen::Vector3d& vertex : ball.vertices) { vertex *= 0.1; }
    const test::MeshFile   file(ball);
    test::Experiment<Exec> fall(
        exec, test::rock_domain({2, 2, 2}, 0, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", "") +
                  test::stone(1e7, 0.3, 0.8) + test::file_shape("ball", file, 0.014, 64) + R"(
[[body]]
name = "ball"
shape = "ball"
density = 2700.0
material = "stone"
velocity = [0.0, 0.0, -1.0]
)" + fmt::format("position = [1.0, 1.0, {}]\n", top + 0.101) +
                  slab + "\n[[phase]]\nname = \"fall\"\nduration = 0.06\n" +
                  (slab.empty() ? "" : "hold = [\"slab\"]\n"));
    Rebound found;
    fall.run(
        [&](double)
        {
            const solver::BodyRow body = fall.simulation().named_bodies()[0];
            found.speed                = std::max(found.speed, body.velocity[2]); // before gravity reduces it
            found.force                = std::max(found.force, body.force.norm());
            fall.simulation().begin_mean();
        });
    return found;
}

/// A slab's equal-volume radius R_s enters R*, where a wall's is infinite: the traction is c = sqrt(1 + R/R_s) of the
/// wall's, and Hertz's F_max scales with c^0.4; the rebound does not depend on the stiffness.
TYPED_TEST(RocksImpact, MeshWallIsAsTheAnalyticOne)
{
    const test::MeshFile file(test::box_mesh({0.3, 0.3, 0.2}));
    const std::string    slab     = test::file_shape("slab", file, 0.014, 40) + R"(
[[body]]
name = "slab"
shape = "slab"
density = 2700.0
material = "floor"
position = [1.0, 1.0, 0.3]
[[material]]
name = "floor"
model = "rigid"
young = 1e16
[[contact]]
between = ["stone", "floor"]
friction = 0.3
restitution = 0.8
)";
    const Rebound        analytic = bounce(this->exec(), "", 0), mesh = bounce(this->exec(), slab, 0.5);
    const double         radius = std::cbrt(0.75 * 8 * 0.3 * 0.3 * 0.2 / std::numbers::pi);
    const double         force  = std::pow(1 + 0.1 / radius, 0.2);
    test::report("speed after over that of the plane", mesh.speed / analytic.speed, 1, 0.02,
                 "restitution is of the law, not of the stiffness; a node in or out of the patch");
    test::report(
        "F_max over that of the plane", mesh.force / analytic.force, force, 0.05,
        "some ten nodes in the patch: 1 to 3 % off Hertz each (docs/verification.md#nodes-and-the-contact-force)");
    EXPECT_GT(analytic.speed, 0.6);
    EXPECT_NEAR(mesh.speed / analytic.speed, 1, 0.02);
    EXPECT_NEAR(mesh.force / analytic.force, force, 0.05);
}

/// A ball of 0.1 m, stiff enough to come and go within two steps of sand, meets the floor within a step, amid its
/// substeps.
TYPED_TEST(RocksImpact, BesideSandABallBouncesAmidAStep)
{
    shape::TriangleMesh ball = shape::icosphere(642, "test");
    for (Eigen::Vector3d& vertex : ball.vertices) { vertex *= 0.1; }
    const test::MeshFile        file(ball);
    test::Experiment<TypeParam> fall(
        this->exec(),
        test::rock_domain({2, 2, 1}, 0, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", "") +
            test::stone(1e10, 0, 1) + test::sand_apart + test::file_shape("ball", file, 0.02, 40) + R"(
[[body]]
name = "ball"
shape = "ball"
density = 2700.0
material = "stone"
position = [1.0, 1.0, 0.102]
velocity = [0.0, 0.0, -1.0]
)" + test::phase("fall", 0, 0.01));
    double       up = 0, down = 0;
    std::int64_t steps = 0;
    fall.run(
        [&](double)
        {
            const double speed = fall.simulation().named_bodies()[0].velocity[2];
            up                 = std::max(up, speed);
            down               = std::max(down, -speed);
            ++steps;
        });
    const double substeps = static_cast<double>(fall.substeps()) / static_cast<double>(steps);
    test::report("speed after over that before", up / down, 1, 0.02,
                 "0.2^2/4 of the energy at either end, as AFaceThatArrivesAtOnceGainsNoEnergy");
    EXPECT_NEAR(up / down, 1, 0.02);
    EXPECT_GT(substeps, 4) << "else the ball came and went in steps";
}

/// A smooth drum that slides, without spin, on a level plane.
std::string sliding_wheel(double speed)
{
    return test::rock_domain({2, 1, 1}, 0, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"",
                             "linear_overlap = 1e-2") +
           test::stone(1e6, 0.3, 1.0) +
           fmt::format(R"(
[[shape]]
name = "drum"
generate = {{ kind = "wheel", radius = 0.2, width = 0.2, wall_thickness = 0.03, grousers = 0, grouser_height = 0.0 }}
node_spacing = 0.008
sdf_cells = 64
[[body]]
name = "drum"
shape = "drum"
mass = 10.0
material = "stone"
position = [0.4, 0.5, 0.2]
velocity = [{}, 0.0, 0.0]
lock = ["y", "roll", "yaw"]
)",
                       speed) +
           test::phase("slide", 0, 0.4);
}

/// docs/verification.md#sliding-to-rolling with the wheel's own inertia: v_f = v0 / (1 + I/(m R^2)), reached after v_f
/// I/(m R^2) / (mu g).
TYPED_TEST(RocksImpact, WheelRollsAsItsOwnInertiaSays)
{
    constexpr double            speed = 0.5, radius = 0.2;
    test::Experiment<TypeParam> slide(this->exec(), sliding_wheel(speed));
    const auto&                 form   = slide.world().templates[0];
    const double                second = form.unit.inertia(1, 1) / form.unit.volume / (radius * radius);
    const double final_speed = speed / (1 + second), slips_for = final_speed * second / (0.3 * test::earth);
    double       sum = 0, spins = 0;
    int          count = 0;
    slide.run(
        [&](double time)
        {
            if (time < 1.5 * slips_for) { return; }
            const solver::BodyRow body = slide.simulation().named_bodies()[0];
            sum += body.velocity[0];
            spins += radius * body.angular_velocity[1];
            ++count;
        });
    ASSERT_GT(count, 10);
    test::report("I / (m R^2)", second, 0.5 * (1 + 0.85 * 0.85), 0.02, "a tube of 170 to 200 mm");
    EXPECT_NEAR(second, 0.5 * (1 + 0.85 * 0.85), 0.02);
    test::report("speed once it rolls, m/s", sum / count, final_speed, 0.01 * final_speed,
                 "1 %: the drum rolls on nodes 8 mm apart");
    test::report("R omega, m/s", spins / count, final_speed, 0.01 * final_speed, "likewise");
    EXPECT_NEAR(sum / count, final_speed, 0.01 * final_speed);
    EXPECT_NEAR(spins / count, final_speed, 0.01 * final_speed);
}

} // namespace
