#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness.hpp"

// Wheels that skid on a rigid plane, yawed and cambered: side forces with their signs.
namespace skids_test
{

using namespace tread;

template<class Exec>
class Skids : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Skids, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeSkids : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeSkids, test::Backends, test::BackendNames);

constexpr double radius = 0.1, width = 0.1, mass = 10, g = 9.81, friction = 0.5, speed = 0.3, span = 0.4;
constexpr double drop   = 1e-4; ///< m, height of the fall on the plane
constexpr double weight = mass * g, degree = std::numbers::pi / 180;

/// A body (keys of its shape in `body`) that stands on a plane with friction when its centre is at `height` (m), in one
/// phase with this motion.
std::string skid_text(const std::string& body, double height, const std::string& motion)
{
    return fmt::format(R"(
title = "a wheel that skids"
[domain]
size    = [4.0, 2.0, 1.0]
gravity = [0.0, 0.0, -{}]
walls   = {{ x = "open", y = "open", bottom = "fixed", top = "open" }}
[[material]]
name  = "steel"
model = "elastic"
young = 1.0e9
[[contact]]
between     = ["steel", "wall"]
friction    = {}
restitution = 0.1
[[shape]]
name      = "drum"
generate  = {{ kind = "wheel", radius = {}, width = {}, wall_thickness = 0.04, grousers = 0, grouser_height = 0.0 }}
sdf_cells = 32
[[shape]]
name      = "ball"
generate  = {{ kind = "sphere", nodes = 162 }}
sdf_cells = 24
[[body]]
name     = "wheel"
material = "steel"
mass     = {}
position = [1.0, 1.0, {}]
{}
[[phase]]
name     = "skid"
duration = {}
motion   = [ {{ body = "wheel", {} }} ]
)",
                       g, friction, radius, width, mass, height + drop, body, span, motion);
}

/// The wheel with means over the last quarter of the run, when it has come to rest on the plane.
template<class Exec>
solver::BodyRow skidding(test::Experiment<Exec>& run)
{
    bool begun = false;
    run.run(
        [&](double time)
        {
            if (begun || time < 0.75 * span) { return; }
            begun = true;
            run.simulation().begin_mean();
        });
    EXPECT_TRUE(begun);
    return run.simulation().named_bodies()[0];
}

void expect_force(const char* what, double found, double expected, double tolerance, const char* why)
{
    test::report(what, found, expected, tolerance, why);
    EXPECT_NEAR(found, expected, tolerance) << what;
}

/// The plane carries the weight: nothing else acts along z.
void expect_weight(const solver::BodyRow& wheel)
{
    expect_force("load, N", wheel.force[2], weight, 1e-3 * weight, "it has come to rest after a tenth of a second");
}

constexpr const char* slid_far = "the friction spring has turned against the slip: it slides 0.1 m, a spring's way is "
                                 "micrometres";

/// A drum that cannot turn is carried along x at a yaw: the ground pushes it against its way with friction times load,
/// in its own axes backwards and, if it points to the left, to the left. Its mount pushes the other way.
TYPED_TEST(Skids, AYawedWheelThatIsHeldIsPushedSidewaysByFrictionTimesLoad)
{
    for (const double yaw_deg : {25.0, -25.0})
    {
        const double                yaw = yaw_deg * degree, ahead = std::cos(yaw), left = -std::sin(yaw);
        test::Experiment<TypeParam> run(
            this->exec(),
            skid_text(fmt::format("shape = \"drum\"\nyaw_deg = {}", yaw_deg), radius,
                      fmt::format("frame = \"body\", rotation_frame = \"body\", x = {{ velocity = {} }}, y = {{ "
                                  "velocity = {} }}, roll = \"held\", pitch = \"held\", yaw = \"held\"",
                                  speed * ahead, speed * left)));
        const solver::BodyRow wheel = skidding(run);
        const double          most = friction * wheel.force[2], tolerance = 1e-6 * weight;
        const Vec3<double>    axle(-std::sin(yaw), std::cos(yaw), 0);
        std::cout << "[ physics  ] yaw of " << yaw_deg << " degrees\n";
        expect_weight(wheel);
        expect_force("side force to the left, N", wheel.force.dot(axle), most * std::sin(yaw), tolerance, slid_far);
        expect_force("force along the way, N", wheel.force[0], -most, tolerance, slid_far);
        expect_force("reaction along the way, N", wheel.reaction_force[0], most, tolerance,
                     "opposite, as nothing accelerates");
        expect_force("reaction across it, N", wheel.reaction_force[1], 0, tolerance, "likewise");
    }
}

/// Cambered, it stands on a rim, and is pushed as before.
TYPED_TEST(FullSizeSkids, ACamberedWheelThatIsHeldIsPushedSidewaysByFrictionTimesLoad)
{
    constexpr double            yaw = 25 * degree, camber = 10 * degree;
    const double                height = radius * std::cos(camber) + 0.5 * width * std::sin(camber);
    test::Experiment<TypeParam> run(
        this->exec(), skid_text("shape = \"drum\"\nyaw_deg = 25.0\ncamber_deg = 10.0", height,
                                fmt::format("x = {{ velocity = {} }}, y = \"held\", roll = \"held\", pitch = \"held\", "
                                            "yaw = \"held\"",
                                            speed)));
    const solver::BodyRow wheel = skidding(run);
    const double          most = friction * wheel.force[2], tolerance = 1e-6 * weight;
    const Vec3<double>    left(-std::sin(yaw), std::cos(yaw), 0);
    expect_weight(wheel);
    expect_force("side force to the left, N", wheel.force.dot(left), most * std::sin(yaw), tolerance, slid_far);
    expect_force("force along the way, N", wheel.force[0], -most, tolerance, slid_far);
}

/// A wheel (a ball, which has no edges) that turns about its axle while it is carried along x. With its heading h and
/// the camber c its lowest point slips at v x - w r cos(c) h, with r the height of its centre: an axle that leans moves
/// that point as a wheel of radius r cos(c) would.
TYPED_TEST(Skids, AWheelThatTurnsIsPushedAgainstTheSlipOfItsLowestPoint)
{
    struct Pose
    {
        double yaw_deg, camber_deg, spin;
    };
    for (const Pose& pose : {Pose{20, 0, 3}, Pose{20, 30, 3}, Pose{-20, 30, 3}, Pose{20, -30, 8}})
    {
        const double                yaw = pose.yaw_deg * degree, camber = pose.camber_deg * degree;
        test::Experiment<TypeParam> run(
            this->exec(),
            skid_text(fmt::format("shape = \"ball\"\ndiameter = {}\nyaw_deg = {}\ncamber_deg = {}", 2 * radius,
                                  pose.yaw_deg, pose.camber_deg),
                      radius,
                      fmt::format("rotation_frame = \"body\", x = {{ velocity = {} }}, y = \"held\", roll = \"held\", "
                                  "yaw = \"held\", axle = {{ velocity = {} }}",
                                  speed, pose.spin)));
        const solver::BodyRow wheel = skidding(run);
        const double       most = friction * wheel.force[2], rolls = pose.spin * wheel.position[2] * std::cos(camber);
        const Vec3<double> heading(std::cos(yaw), std::sin(yaw), 0), slip = Vec3<double>(speed, 0, 0) - rolls * heading;
        const Vec3<double> expected = -most / slip.norm() * slip;
        const char*        why = "a leaning axle turns the friction spring by 1e-4 rad while it slides a spring's way";
        std::cout << "[ physics  ] yaw " << pose.yaw_deg << ", camber " << pose.camber_deg << " degrees, " << pose.spin
                  << " rad/s: slip of " << slip[0] << " and " << slip[1] << " m/s\n";
        expect_weight(wheel);
        expect_force("force along x, N", wheel.force[0], expected[0], 1e-4 * most, why);
        expect_force("force along y, N", wheel.force[1], expected[1], 1e-4 * most, why);
    }
}

} // namespace skids_test
