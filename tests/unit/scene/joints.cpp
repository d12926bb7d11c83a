#include <filesystem>
#include <ostream>

#include <gmock/gmock.h>

#include "scene/resolved.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;

/// The good scene with a second body and joints of all kinds; the tables of joints begin at line 61.
const std::string jointed = good_scene + R"([[body]]
name = "frame"
shape = "viper"
material = "steel"
mass = 20
position = [0.2, 0.5, 0.8]
[[joint]]
name = "axle"
type = "revolute"
between = ["frame", "wheel"]
at = [0.5, 0.5, 0.6]
axis = [0, 1, 0]
motor = { speed = 0.5, max_torque = 20, from = "drive" }
[[joint]]
name = "pin"
type = "revolute"
between = ["frame", "world"]
at = [0.5, 0.6, 0.6]
axis = [0, 1, 0]
limits_deg = [-20, 30]
stiffness = 4
[[joint]]
name = "both"
type = "differential"
joints = ["axle", "pin"]
[[joint]]
name = "strut"
type = "spring"
between = ["world", "frame"]
at = [0.2, 0.5, 1]
to = [0.2, 0.5, 0.8]
stiffness = 100
damping = 3
[[joint]]
name = "rail"
type = "prismatic"
between = ["world", "frame"]
at = [0.2, 0.5, 0.8]
axis = [1, 0, 0]
limits = [-0.1, 0.2]
)";

TEST(Joints, of_every_kind_are_read_and_written)
{
    const Directory directory;
    const Scene     scene = load_scene(directory.write("scene.toml", jointed), {});
    ASSERT_EQ(scene.joints.size(), 5u);
    EXPECT_EQ(scene.joints[0].between, (std::array<std::string, 2>{"frame", "wheel"}));
    EXPECT_EQ(scene.joints[0].motor, (Motor{0.5, 20, std::nullopt, "drive"}));
    EXPECT_EQ(scene.joints[1].limits_deg, (JointLimits{-20, 30}));
    EXPECT_EQ(scene.joints[2].joints, (std::array<std::string, 2>{"axle", "pin"}));
    EXPECT_EQ(scene.joints[3].damping, 3);
    EXPECT_EQ(scene.joints[4].limits, (JointLimits{-0.1, 0.2}));
    EXPECT_EQ(scene.joints[4].drift, 1e-4);
    EXPECT_EQ(load_scene(directory.write("again.toml", resolved_toml(scene)), {}), scene);
}

/// Replaces `from` in the scene of joints by `to`; the message must hold `said`.
struct BadJoint
{
    const char* name;
    std::string from;
    std::string to;
    std::string said;
};

std::ostream& operator<<(std::ostream& stream, const BadJoint& bad) { return stream << bad.name; }

class BadJoints : public ::testing::TestWithParam<BadJoint>
{
};

TEST_P(BadJoints, are_refused_with_file_line_and_key)
{
    const auto message = refusal(replaced(jointed, GetParam().from, GetParam().to));
    EXPECT_THAT(message, HasSubstr("bad.toml:"));
    EXPECT_THAT(message, HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    Scene, BadJoints,
    ::testing::Values(
        BadJoint{"unknown_type", "\"prismatic\"", "\"slider\"", "[joint.rail] type: unknown word \"slider\""},
        BadJoint{"unknown_body", "[\"frame\", \"wheel\"]", "[\"frame\", \"wheal\"]",
                 "[joint.axle] between: there is no [[body]] called \"wheal\"; did you mean \"wheel\"?"},
        BadJoint{"one_body", "[\"frame\", \"wheel\"]", "[\"frame\", \"frame\"]",
                 "[joint.axle] between: \"frame\" twice"},
        BadJoint{"no_axis", "axis = [1, 0, 0]", "axis = [0, 0, 0]", "[joint.rail] axis: it has no direction"},
        BadJoint{"missing_axis", "axis = [1, 0, 0]\n", "", "[joint.rail] axis: missing"},
        BadJoint{"limits_of_the_wrong_kind", "limits_deg = [-20, 30]", "limits = [-20, 30]",
                 "[joint.pin] limits: may stand only with type = \"prismatic\""},
        BadJoint{"limits_in_reverse", "[-20, 30]", "[30, -20]", "[joint.pin] limits_deg: [30.0, -20.0]; accepted: "},
        BadJoint{"limits_beside_the_start", "[-0.1, 0.2]", "[0.1, 0.2]", "[joint.rail] limits: [0.1, 0.2]; accepted: "},
        BadJoint{"limits_beyond_a_turn", "[-20, 30]", "[-20, 400]", "[joint.pin] limits_deg"},
        BadJoint{"motor_without_torque", "max_torque = 20", "max_torque = 0", "[joint.axle.motor] max_torque: 0"},
        BadJoint{"motor_from_no_phase", "from = \"drive\"", "from = \"drift\"",
                 "[joint.axle] motor: there is no [[phase]] called \"drift\""},
        BadJoint{"motor_of_a_rail", "limits = [-0.1, 0.2]", "motor = { speed = 1, max_torque = 1 }",
                 "[joint.rail] motor: may stand only with type = \"revolute\""},
        BadJoint{"differential_of_a_rail", "[\"axle\", \"pin\"]", "[\"axle\", \"rail\"]",
                 "[joint.both] joints: \"rail\" is not revolute"},
        BadJoint{"differential_of_one", "[\"axle\", \"pin\"]", "[\"axle\", \"axle\"]",
                 "[joint.both] joints: \"axle\" twice"},
        BadJoint{"differential_of_two_frames", "[\"frame\", \"world\"]", "[\"world\", \"frame\"]",
                 "[joint.both] joints: they have different first bodies or axes"},
        BadJoint{"spring_without_stiffness", "stiffness = 100\ndamping = 3\n", "",
                 "[joint.strut]: neither stiffness nor damping"},
        BadJoint{"spring_without_length", "at = [0.2, 0.5, 1]", "at = [0.2, 0.5, 0.8]",
                 "[joint.strut] to: the ends of the spring are the same"},
        BadJoint{"setting_of_no_joint", "drive = { body = \"wheel\", angular_velocity = 0.7, slip = 0.3 }",
                 "motors = [{ joint = \"axel\", speed = 1 }]",
                 "[phase.drive] motors: there is no [[joint]] called \"axel\"; did you mean \"axle\"?"},
        BadJoint{"setting_of_a_joint_without_motor", "drive = { body = \"wheel\", angular_velocity = 0.7, slip = 0.3 }",
                 "motors = [{ joint = \"pin\", speed = 1 }]", "[phase.drive] motors: \"pin\" has no motor"},
        BadJoint{"two_settings_of_a_motor", "drive = { body = \"wheel\", angular_velocity = 0.7, slip = 0.3 }",
                 "motors = [{ joint = \"axle\", speed = 1 }, { joint = \"axle\", speed = 2 }]",
                 "[phase.drive] motors: \"axle\" twice"},
        BadJoint{"two_of_a_name", "name = \"pin\"", "name = \"axle\"", "\"axle\" is also the name of [[joint]] 0"},
        BadJoint{"body_called_world", "name = \"frame\"", "name = \"world\"", "[body.world] name: \"world\" is what"}),
    [](const auto& bad) { return bad.param.name; });

TEST(Joints, of_the_rovers_that_come_with_the_code_are_read)
{
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator("../configs/rover"))
    {
        if (entry.path().extension() != ".toml") { continue; }
        EXPECT_FALSE(load_scene(entry.path().string(), {}).joints.empty()) << entry.path();
        ++scenes;
    }
    EXPECT_EQ(scenes, 8);
}

TEST(Joints, have_motors_that_phases_set)
{
    const Directory   directory;
    const std::string text  = replaced(jointed, "drive = { body = \"wheel\", angular_velocity = 0.7, slip = 0.3 }",
                                       "motors = [{ joint = \"axle\", speed = -1.5, max_torque = 3 }]");
    const Scene       scene = load_scene(directory.write("scene.toml", text), {});
    ASSERT_EQ(scene.phases.back().motors.size(), 1u);
    EXPECT_EQ(scene.phases.back().motors[0], (MotorSetting{"axle", -1.5, 3}));
    EXPECT_EQ(load_scene(directory.write("again.toml", resolved_toml(scene)), {}), scene);
}

TEST(Joints, with_a_motor_need_a_side_that_moves)
{
    const std::string held =
        replaced(replaced(jointed, "hold = [\"wheel\"]", "hold = [\"wheel\", \"frame\"]"),
                 "drive = { body = \"wheel\", angular_velocity = 0.7, slip = 0.3 }", "hold = [\"wheel\", \"frame\"]");
    EXPECT_THAT(refusal(held), HasSubstr("[joint.axle] motor: both sides are held in every phase"));
    const std::string turned =
        replaced(replaced(jointed, "hold = [\"wheel\"]", "hold = [\"wheel\", \"frame\"]"),
                 "drive = { body = \"wheel\", angular_velocity = 0.7, slip = 0.3 }",
                 "hold = [\"wheel\"]\nmotion = [{ body = \"frame\", roll = \"held\", yaw = \"held\", "
                 "axle = { velocity = 1 } }]");
    EXPECT_THAT(refusal(turned), HasSubstr("[joint.axle] motor: both sides are held in every phase"));
}

} // namespace
} // namespace tread::scene::test
