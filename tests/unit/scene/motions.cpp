#include <algorithm>
#include <ostream>
#include <utility>

#include <gmock/gmock.h>

#include "scene/resolved.hpp"
#include "scene/time_table.hpp"
#include "scene_file.hpp"

// [[phase]] motion: what is read, what is refused, and where.
namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;

/// good_scene with a motion of the wheel in a third phase, which begins at this line.
std::string with_motion(const std::string& motion)
{
    return good_scene + "[[phase]]\nname = \"test\"\nduration = 2.0\nmotion = [\n" + motion + "\n]\n";
}

int lines_of(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

/// A motion that is refused with exactly one message, which contains `said`.
struct BadMotion
{
    const char* name;
    std::string motion;
    std::string said;
    std::string body_keys = {}; ///< further keys of the body
};

std::ostream& operator<<(std::ostream& stream, const BadMotion& bad) { return stream << bad.name; }

class Motions : public ::testing::TestWithParam<BadMotion>
{
};

TEST_P(Motions, are_refused_with_file_line_and_key)
{
    const BadMotion&  bad     = GetParam();
    const std::string text    = replaced(with_motion(bad.motion), "mass = 10", "mass = 10" + bad.body_keys);
    const int         line    = lines_of(good_scene) + 5 + lines_of(bad.body_keys) + lines_of(bad.motion);
    const auto        message = refusal(text);
    EXPECT_THAT(message, HasSubstr("bad.toml:" + std::to_string(line) + ": "));
    EXPECT_THAT(message, HasSubstr(bad.said));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
}

const std::vector<BadMotion> bad_motions{
    {"unknown_body", "{ body = \"weel\" }",
     "[phase.test.motion[0]] body: there is no [[body]] called \"weel\"; did you"},
    {"no_body", "{ x = \"held\" }", "[phase.test.motion[0]] body: missing"},
    {"two_of_one_body", "{ body = \"wheel\" },\n{ body = \"wheel\", x = \"held\" }",
     "[phase.test.motion[1]] body: motion 0 of this phase moves \"wheel\" too; accepted: one motion a body and phase"},
    {"unknown_key", "{ body = \"wheel\", axel = \"held\" }",
     "[phase.test.motion[0]] axel: unknown key; did you mean \"axle\"?"},
    {"unknown_word", "{ body = \"wheel\", x = \"locked\" }",
     "[phase.test.motion[0]] x: unknown word \"locked\"; accepted: \"free\" | \"held\" | { velocity = ... } | { force"},
    {"force_of_a_rotation", "{ body = \"wheel\", yaw = { force = 3.0 } }",
     "[phase.test.motion[0]] yaw: neither of velocity, torque"},
    {"velocity_and_force", "{ body = \"wheel\", x = { velocity = 1.0, force = 1.0 } }",
     "[phase.test.motion[0]] x: both of velocity, force"},
    {"velocity_out_of_range", "{ body = \"wheel\", x = { velocity = 1e6 } }",
     "[phase.test.motion[0].x] velocity: 1000000 is out of range; accepted: number >= -10000 and <= 10000, or { table"},
    {"from_without_ramp", "{ body = \"wheel\", x = { velocity = 1.0, from = 0.5 } }",
     "[phase.test.motion[0].x] from: may stand only with a ramp"},
    {"velocity_where_lock_holds", "{ body = \"wheel\", y = { velocity = 1.0 } }",
     "[phase.test.motion[0]] y: `lock` of \"wheel\" holds that axis", "\nlock = [\"y\"]"},
    {"force_where_lock_holds", "{ body = \"wheel\", y = { force = 1.0 } }",
     "[phase.test.motion[0]] y: `lock` of \"wheel\" holds that axis", "\nlock = [\"y\"]"},
    {"body_frame_where_lock_holds", "{ body = \"wheel\", frame = \"body\", x = \"held\" }",
     "[phase.test.motion[0]] frame: `lock` of \"wheel\" holds y in the world's axes", "\nlock = [\"y\"]"},
    {"torque_on_a_held_axle", "{ body = \"wheel\", pitch = \"held\", axle = { torque = 1.0 } }",
     "[phase.test.motion[0]] axle: pitch is held or driven too"},
    {"torque_where_lock_holds", "{ body = \"wheel\", axle = { torque = 1.0 } }",
     "[phase.test.motion[0]] axle: pitch is held or driven too", "\nlock = [\"pitch\"]"},
    {"friction_of_a_driven_axle", "{ body = \"wheel\", axle = { velocity = 1.0 }, axle_friction = 2.0 }",
     "[phase.test.motion[0]] axle_friction: the rotation about the axle is held or prescribed"},
    {"load_on_a_held_axis", "{ body = \"wheel\", z = \"held\", load = 100.0 }",
     "[phase.test.motion[0]] load: z is held or prescribed"},
    {"carriage_on_a_held_axis",
     "{ body = \"wheel\", z = { velocity = 1.0 }, carriage = { stiffness = 1e3, height = 1.0 } }",
     "[phase.test.motion[0]] carriage: z is held or prescribed"},
    {"carriage_without_height", "{ body = \"wheel\", carriage = { stiffness = 1e3 } }",
     "[phase.test.motion[0].carriage] height: missing"},
    {"stop_along_a_held_axis", "{ body = \"wheel\", x = \"held\", until = { displacement_x = 0.1 } }",
     "[phase.test.motion[0]] until: displacement_x can never be reached: x is held"},
    {"stop_along_a_locked_axis", "{ body = \"wheel\", until = { displacement_y = 0.1 } }",
     "[phase.test.motion[0]] until: displacement_y can never be reached: y is held", "\nlock = [\"y\"]"},
    {"no_stop", "{ body = \"wheel\", until = {} }", "[phase.test.motion[0]] until: names no stop; accepted: force_x"},
    {"table_missing", "{ body = \"wheel\", x = { velocity = { table = \"none.csv\", column = \"v\" } } }",
     "[phase.test.motion[0].x] table: "},
    {"table_with_a_ramp",
     "{ body = \"wheel\", x = { velocity = { table = \"none.csv\", column = \"v\" }, ramp = 1.0 } }",
     "[phase.test.motion[0].x] ramp: may stand only without a table"},
};

std::string motion_name(const ::testing::TestParamInfo<BadMotion>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Motion, Motions, ::testing::ValuesIn(bad_motions), motion_name);

TEST(Motion, stands_alone_with_the_other_keys_of_its_phase)
{
    const std::string motion = "motion = [ { body = \"wheel\" } ]";
    EXPECT_THAT(refusal(replaced(good_scene, "hold = [\"wheel\"]", "hold = [\"wheel\"]\n" + motion)),
                HasSubstr("body: `hold` of this phase names \"wheel\" too"));
    EXPECT_THAT(refusal(replaced(good_scene, "duration = 2\n", "duration = 2\n" + motion + "\n")),
                HasSubstr("body: `drive` of this phase names \"wheel\" too"));
}

TEST(Motion, is_an_array)
{
    EXPECT_THAT(refusal(good_scene + "[[phase]]\nname = \"test\"\nduration = 2.0\nmotion = \"wheel\"\n"),
                HasSubstr("[phase.test] motion: wrong type"));
}

/// A plate in a domain without walls, with a motion in its only phase.
std::string afloat(const std::string& motion, const std::string& more = {})
{
    return R"([domain]
size = [1.0, 1.0, 1.0]
gravity = [0, 0, 0]
walls = { x = "open", y = "open", bottom = "open", top = "open" }
[[material]]
name = "steel"
model = "elastic"
young = 1e9
[[shape]]
name = "plate"
generate = { kind = "box", size = [0.1, 0.1, 0.1] }
[[body]]
name = "plate"
shape = "plate"
material = "steel"
mass = 1.0
position = [0.5, 0.5, 0.5]
[[phase]]
name = "push"
duration = 1.0
motion = [ { body = "plate", )" +
           motion + " } ]\n" + more;
}

/// The message for a force or torque (key) in the motion of afloat() that reaches no ground.
std::string without_ground(const std::string& text, const std::string& key)
{
    const int line = lines_of(text.substr(0, text.find("motion = ["))) + 1;
    return fmt::format("bad.toml:{}: [phase.push.motion[0]] {}: nothing takes up what acts on \"plate\"; accepted: "
                       "joints, or pairs that touch, from it to \"world\"",
                       line, key);
}

TEST(Motion, with_a_force_that_nothing_takes_up_is_refused)
{
    for (const auto& [key, motion] : {std::pair{"y", "y = { force = 1.0 }"}, std::pair{"yaw", "yaw = { torque = 1.0 }"},
                                      std::pair{"axle", "axle = { torque = 1.0 }"}, std::pair{"load", "load = 1.0"}})
    {
        EXPECT_THAT(refusal(afloat(motion)), HasSubstr(without_ground(afloat(motion), key)));
    }
    EXPECT_EQ(refusal(afloat("x = { velocity = 1.0 }")), "");
}

/// What stands beside the plate: keys of the phase and tables after it, and the domain's floor.
struct Beside
{
    const char* name;
    bool        takes_up; ///< whether a force on the plate reaches ground
    std::string more;
    const char* floor = "open";
};

std::ostream& operator<<(std::ostream& stream, const Beside& beside) { return stream << beside.name; }

class Forces : public ::testing::TestWithParam<Beside>
{
};

TEST_P(Forces, need_a_path_to_ground)
{
    const std::string floor = fmt::format("bottom = \"{}\"", GetParam().floor);
    const std::string text  = replaced(afloat("y = { force = 1.0 }", GetParam().more), "bottom = \"open\"", floor);
    if (GetParam().takes_up) { EXPECT_EQ(refusal(text), ""); }
    else { EXPECT_THAT(refusal(text), HasSubstr(without_ground(text, "y"))); }
}

const std::string arm_text = R"([[material]]
name = "brass"
model = "elastic"
young = 1e9
[[body]]
name = "arm"
shape = "plate"
material = "brass"
mass = 1.0
position = [0.5, 0.8, 0.5]
)";

std::string apart(const std::string& one, const std::string& other)
{
    return fmt::format("[[contact]]\nbetween = [\"{}\", \"{}\"]\ntouch = false\n", one, other);
}

std::string joined(const std::string& one, const std::string& other)
{
    return fmt::format("[[joint]]\nname = \"{0}_{1}\"\ntype = \"spherical\"\nbetween = [\"{0}\", \"{1}\"]\nat = "
                       "[0.5, 0.65, 0.5]\n",
                       one, other);
}

const std::string ground_text = R"([grid]
spacing = 0.1
[[material]]
name = "sand"
model = "elastic"
density = 1600
young = 1e6
poisson = 0.3
[[terrain]]
material = "sand"
region = { box = [[0, 0, 0], [1, 1, 0.2]] }
)";

INSTANTIATE_TEST_SUITE_P(
    Motion, Forces,
    ::testing::Values(
        Beside{"floor", true, "", "fixed"}, Beside{"floor_without_touch", false, apart("steel", "wall"), "fixed"},
        Beside{"floor_without_touch_in_the_phase", false,
               "contacts = [ { between = [\"steel\", \"wall\"], touch = false } ]\n", "fixed"},
        Beside{"floor_under_a_body_that_it_touches", true, arm_text + apart("steel", "wall"), "fixed"},
        Beside{"floor_under_a_body_that_it_passes", false, arm_text + apart("steel", "wall") + apart("steel", "brass"),
               "fixed"},
        Beside{"floor_under_a_body_of_its_joint", true,
               arm_text + apart("steel", "wall") + apart("steel", "brass") + joined("plate", "arm"), "fixed"},
        Beside{"sand", true, ground_text}, Beside{"sand_without_touch", false, ground_text + apart("steel", "sand")},
        Beside{"joint_to_the_world", true, joined("world", "plate")},
        Beside{"two_joints_to_the_world", true,
               arm_text + apart("steel", "brass") + joined("world", "arm") + joined("arm", "plate")},
        Beside{"joint_of_another_mechanism_to_the_world", false,
               arm_text + apart("steel", "brass") + joined("world", "arm")},
        Beside{"body_afloat", false, arm_text},
        Beside{"joint_to_a_body_afloat", false, arm_text + joined("arm", "plate")},
        Beside{"held_body", true, "hold = [\"arm\"]\n" + arm_text},
        Beside{"held_body_that_it_passes", false, "hold = [\"arm\"]\n" + arm_text + apart("steel", "brass")},
        Beside{"locked_body", true, replaced(arm_text, "mass = 1.0", "mass = 1.0\nlock = [\"y\"]")},
        Beside{"body_that_may_not_roll", false, replaced(arm_text, "mass = 1.0", "mass = 1.0\nlock = [\"roll\"]")}),
    [](const auto& beside) { return beside.param.name; });

/// The fault of a table whose file has this text, read for a phase of 2 s.
std::string fault_of(const std::string& text, const std::string& column)
{
    const Directory directory;
    TimeTable       table{directory.write("table.csv", text), column, {}, {}};
    const auto      fault = read_time_table(table, between(-10, 10), 2.0);
    return fault ? fmt::format("{} {}: {}; {}", fault->line, fault->key, fault->what, fault->accepted) : std::string();
}

TEST(TimeTable, is_refused_by_line)
{
    EXPECT_EQ(fault_of("time,v\n0,1\n2,3\n", "v"), "");
    EXPECT_THAT(fault_of("", "v"), HasSubstr("1 table: the file is empty"));
    EXPECT_THAT(fault_of("t,v\n0,1\n2,3\n", "v"), HasSubstr("1 table: the first line names no column `time`"));
    EXPECT_THAT(fault_of("time,v\n0,1\n2,3\n", "u"), HasSubstr("1 column: there is no column \"u\"; time, v"));
    EXPECT_THAT(fault_of("time,v\n", "v"), HasSubstr("no row of numbers"));
    EXPECT_THAT(fault_of("time,v\n0,1\n1,2\n1,3\n2,4\n", "v"), HasSubstr("4 table: time 1 does not come after 1"));
    EXPECT_THAT(fault_of("time,v\n0,1\n1,x\n", "v"), HasSubstr("3 table: \"x\" is out of range"));
    EXPECT_THAT(fault_of("time,v\n0,1\n1,11\n", "v"), HasSubstr("3 table: \"11\" is out of range; number >= -10"));
    EXPECT_THAT(fault_of("time,v\n0,1\nnan,1\n", "v"), HasSubstr("3 table: the time is no finite number"));
    EXPECT_THAT(fault_of("time,v\n0,1\n1\n", "v"), HasSubstr("3 table: 1 values; 2, as the first line has"));
    EXPECT_THAT(fault_of("time,v\n0.1,1\n2,3\n", "v"), HasSubstr("begins at 0.1 s, after the phase"));
    EXPECT_THAT(fault_of("time,v\n0,1\n1.5,3\n", "v"), HasSubstr("3 table: the table ends at 1.5 s, before the phase"));
}

TEST(TimeTable, is_linear_between_rows)
{
    const Directory directory;
    TimeTable       table{directory.write("table.csv", "v, time\n1,-1\n3, 1\n\n0,2.5\n"), "v", {}, {}};
    ASSERT_FALSE(read_time_table(table, between(-10, 10), 2.0));
    EXPECT_DOUBLE_EQ(value_at(table, 0), 2);
    EXPECT_DOUBLE_EQ(value_at(table, 1), 3);
    EXPECT_DOUBLE_EQ(value_at(table, 1.75), 1.5);
    EXPECT_DOUBLE_EQ(value_at(table, 9), 0);
}

TEST(Motion, of_a_table_is_refused_with_scene_and_table)
{
    const Directory directory;
    directory.write("way.csv", "time,v\n0,0\n1,1\n");
    const std::string path = directory.write(
        "scene.toml", with_motion("{ body = \"wheel\", x = { velocity = { table = \"way.csv\", column = \"v\" } } }"));
    try
    {
        load_scene(path, {});
        FAIL() << "the table is too short";
    }
    catch (const InputError& error)
    {
        EXPECT_THAT(error.what(), HasSubstr(fmt::format("scene.toml:{}: [phase.test.motion[0].x] table: ",
                                                        lines_of(good_scene) + 5)));
        EXPECT_THAT(error.what(), HasSubstr("way.csv:3: the table ends at 1 s, before the phase, which may take 2 s; "
                                            "accepted: a last time >= 2 (s)"));
    }
}

TEST(Motion, reads_back_as_written)
{
    const Directory directory;
    directory.write("way.csv", "time,v\n0,0\n3,1\n");
    const std::string text  = with_motion("{ body = \"wheel\", frame = \"body\", x = { velocity = { table = "
                                           "\"way.csv\", column = \"v\" } }, y = \"held\", z "
                                           "= { force = -3.5, ramp = 0.5, from = 1.0 }, roll = \"held\", yaw = { "
                                           "velocity = 0.25, ramp = 0.125 }, axle = { "
                                           "torque = 2.0 }, axle_friction = 0.5, load = { force = 40.0, ramp = 1.0 }, "
                                           "carriage = { stiffness = 1e4, damping = "
                                           "20.0, height = 0.5 }, until = { force_z = 200.0, displacement_x = 0.1 } }");
    const Scene       scene = load_scene(directory.write("scene.toml", text), {});
    ASSERT_EQ(scene.phases.back().motion.size(), 1U);
    const Motion& motion = scene.phases.back().motion.front();
    EXPECT_EQ(motion.translation[0].course.table->value, (std::vector<double>{0, 1}));
    EXPECT_EQ(motion.translation[2].kind, AxisKind::effort);
    EXPECT_EQ(motion.translation[2].course.from, 1.0);
    EXPECT_EQ(motion.rotation[2].course.ramp, 0.125);
    EXPECT_EQ(motion.until->force[2], 200.0);
    const std::string resolved = resolved_toml(scene);
    EXPECT_EQ(resolved_toml(load_scene(directory.write("resolved.toml", resolved), {})), resolved);
    EXPECT_EQ(load_scene(directory.write("resolved.toml", resolved), {}).phases, scene.phases);
}

/// ctest runs this program in tests/.
TEST(RigScenes, load)
{
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator("../configs/rig"))
    {
        if (entry.path().extension() != ".toml") { continue; }
        EXPECT_NO_THROW(load_scene(entry.path().string(), {})) << entry.path();
        ++scenes;
    }
    EXPECT_EQ(scenes, 7);
}

} // namespace
} // namespace tread::scene::test
