#include <algorithm>

#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

constexpr double widest_angle = 179; ///< degrees; an angle is known up to a whole turn

Value<std::optional<JointLimits>> limits_given(Range range)
{
    const auto read = [=](const Node& node) -> std::optional<JointLimits>
    {
        const NodeArray&  items = read_array(node, 2);
        const JointLimits limits{read_number(items[0], range), read_number(items[1], range)};
        if (limits[0] < limits[1] && limits[0] <= 0 && limits[1] >= 0) { return limits; }
        throw BadValue{fmt::format("[{}, {}]", write_number(limits[0]), write_number(limits[1]))};
    };
    const auto write = [](const std::optional<JointLimits>& limits) {
        return limits ? fmt::format("[{}, {}]", write_number((*limits)[0]), write_number((*limits)[1])) : std::string();
    };
    return {fmt::format("[low, high], each a {}, low < high, around 0: the joint's place at the start", range.text()),
            read, write};
}

bool has_axis(const Joint& joint) { return joint.type == JointType::revolute || joint.type == JointType::prismatic; }
bool ties_bodies(const Joint& joint) { return joint.type != JointType::differential; }
bool has_spring(const Joint& joint) { return has_axis(joint) || joint.type == JointType::spring; }
bool is_spring(const Joint& joint) { return joint.type == JointType::spring; }
bool is_revolute(const Joint& joint) { return joint.type == JointType::revolute; }

Keys<Motor> motor_keys()
{
    return {
        required("speed", "rad/s", &Motor::speed, number(spin()), "Of the second body against the first."),
        required("max_torque", "N m", &Motor::max_torque, number(above_up_to(0, 1e12)), "Largest torque, either way."),
        optional("gain", "N m s/rad", &Motor::gain, number_or("", above_up_to(0, 1e12)), "Torque per missing speed.",
                 "as much torque as the speed needs, up to `max_torque`"),
        optional("from", "", &Motor::from, name(),
                 "The phase from which on `speed` holds; until then the motor holds the speed 0.", "the first phase"),
    };
}

Keys<MotorSetting> motor_setting_keys()
{
    return {
        required("joint", "", &MotorSetting::joint, name(),
                 "The name of a [[joint]] with a `motor`. One setting a joint and phase."),
        required("speed", "rad/s", &MotorSetting::speed, number(spin()),
                 "Of its second body against the first, from this phase on until another one sets it."),
        optional("max_torque", "N m", &MotorSetting::max_torque, number_or("", above_up_to(0, 1e12)),
                 "Largest torque, likewise.", "as before"),
    };
}

} // namespace

Keys<Joint> joint_keys()
{
    const std::string axial = "type = \"revolute\" or \"prismatic\"", sprung = axial + " or \"spring\"";
    const std::string tied = "a type other than \"differential\"";
    return {
        required("name", "", &Joint::name, name(),
                 "Unique among joints; rows stand in `/joint/<name>` of the time series."),
        required("type", "", &Joint::type, word<JointType>(),
                 "\"revolute\" turns about its axis, \"prismatic\" slides along it, \"spherical\" turns about its "
                 "point, \"fixed\" does neither. \"differential\": the angles of two revolute joints have the sum 0, "
                 "so that a rover's body pitches by the mean of its rockers. \"spring\": spring and damper along the "
                 "line between two points."),
        required("between", "", &Joint::between, pair_of_names(),
                 "Two bodies, or \"world\" and a body. The second moves against the first. They do not touch "
                 "each other, unless by a spring alone: their shapes may overlap.")
            .when(tied, ties_bodies),
        required("at", "m", &Joint::at, vector3(coordinate()),
                 "Place of the joint at the start; of a spring: its end on the first body.")
            .when(tied, ties_bodies),
        required("to", "m", &Joint::to, vector3(coordinate()), "The end of a spring on the second body, at the start.")
            .when("type = \"spring\"", is_spring),
        required("axis", "", &Joint::axis, vector3(coordinate()), "Direction of the axis at the start.")
            .when(axial, has_axis),
        required("joints", "", &Joint::joints, pair_of_names(),
                 "The two revolute joints of a differential, both with the same axis and the same first body.")
            .when("type = \"differential\"", [](const Joint& joint) { return !ties_bodies(joint); }),
        optional("limits", "m", &Joint::limits, limits_given(coordinate()), "Stops, without bounce.", "no stops")
            .when("type = \"prismatic\"", [](const Joint& joint) { return joint.type == JointType::prismatic; }),
        optional("limits_deg", "degrees", &Joint::limits_deg, limits_given(between(-widest_angle, widest_angle)),
                 "Stops, without bounce.", "no stops")
            .when("type = \"revolute\"", is_revolute),
        optional("stiffness", "N/m or N m/rad", &Joint::stiffness, number_or("", above_up_to(0, 1e15)),
                 "Of a spring along or about the axis, without load at the start, or between the ends of a spring. "
                 "A joint with a spring may turn by less than half a turn.",
                 "no spring")
            .when(sprung, has_spring),
        optional("damping", "N s/m or N m s/rad", &Joint::damping, number_or("", above_up_to(0, 1e15)),
                 "Of a damper beside the spring.", "no damper")
            .when(sprung, has_spring),
        optional("length", "m", &Joint::length, number_or("", length()), "Of a spring without load.",
                 "its length at the start")
            .when("type = \"spring\"", is_spring),
        table_key<Joint>(Presence::optional, "motor", "[[joint]] motor", &Joint::motor, motor_keys(),
                         "A motor with a speed controller about the axis.", "no motor")
            .when("type = \"revolute\"", is_revolute),
        optional("drift", "m and rad", &Joint::drift, number(above_up_to(0, 1)),
                 "The error of the joint's place or direction, or the way beyond its limits, at which the run stops."),
    };
}

Key<Phase> phase_motors_key()
{
    return tables_key<Phase>("motors", "[[phase]] motors", &Phase::motors, motor_setting_keys(),
                             "What motors of joints do from this phase on.", "they go on");
}

} // namespace tread::scene
