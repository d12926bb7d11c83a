#include <algorithm>

#include <fmt/format.h>

#include "scene/checker.hpp"

// Cross checks of [[joint]] tables. Loops that are closed twice are found when the world is built.
namespace tread::scene
{
namespace
{

const Joint* find_joint(const Scene& scene, const std::string& name)
{
    const auto found =
        std::find_if(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) { return joint.name == name; });
    return found == scene.joints.end() ? nullptr : &*found;
}

/// Whether a motion holds or prescribes all rotation.
bool turns_as_told(const Motion& motion)
{
    const auto told = [](const AxisMotion& axis)
    { return axis.kind == AxisKind::held || axis.kind == AxisKind::velocity; };
    return told(motion.rotation[0]) && told(motion.rotation[2]) && (told(motion.rotation[1]) || told(motion.axle));
}

/// Whether no torque turns a side of a joint in a phase.
bool is_held(const Phase& phase, const std::string& side)
{
    const bool moved = std::any_of(phase.motion.begin(), phase.motion.end(),
                                   [&](const Motion& motion) { return motion.body == side && turns_as_told(motion); });
    return moved || side == world_side || std::find(phase.hold.begin(), phase.hold.end(), side) != phase.hold.end();
}

void check_sides(const Scene& scene, const Joint& joint, const TableAt& at, Checker& checker)
{
    std::vector<std::string> sides = names_in(scene.bodies);
    sides.emplace_back(world_side);
    for (const std::string& side : joint.between) { checker.require_known(at, "between", side, sides, "[[body]]"); }
    if (joint.between[0] == joint.between[1] && checker.sound(at, {"between"}))
    {
        checker.report(at, "between", fmt::format("\"{}\" twice", joint.between[0]),
                       "two bodies, or \"world\" and one");
    }
}

void check_geometry(const Joint& joint, const TableAt& at, Checker& checker)
{
    const bool axial = joint.type == JointType::revolute || joint.type == JointType::prismatic;
    if (axial && joint.axis == std::array<double, 3>{} && checker.sound(at, {"axis"}))
    {
        checker.report(at, "axis", "it has no direction", "a vector other than [0, 0, 0]");
    }
    if (joint.type != JointType::spring) { return; }
    if (joint.at == joint.to && checker.sound(at, {"at", "to"}))
    {
        checker.report(at, "to", "the ends of the spring are the same, which leaves it no direction", "another point");
    }
    if (!joint.stiffness && !joint.damping && checker.sound(at, {"stiffness", "damping"}))
    {
        checker.report(at, "", "neither stiffness nor damping", "at least one of stiffness, damping");
    }
}

void check_motor(const Scene& scene, const Joint& joint, const TableAt& at, Checker& checker)
{
    if (!joint.motor) { return; }
    if (!joint.motor->from.empty())
    {
        checker.require_known(at, "motor", joint.motor->from, names_in(scene.phases), "[[phase]]");
    }
    const bool held = std::all_of(scene.phases.begin(), scene.phases.end(),
                                  [&](const Phase& phase)
                                  { return is_held(phase, joint.between[0]) && is_held(phase, joint.between[1]); });
    if (held && !scene.phases.empty() && checker.sound(at, {"between"}))
    {
        checker.report(at, "motor", "both sides are held in every phase",
                       "a body that `hold` or `motion` of some phase leaves free to turn");
    }
}

/// Settings of motors in a phase name joints with a motor, each once.
void check_settings(const Scene& scene, const Phase& phase, const TableAt& at, Checker& checker)
{
    const std::vector<std::string> names = names_in(scene.joints);
    for (auto setting = phase.motors.begin(); setting != phase.motors.end(); ++setting)
    {
        checker.require_known(at, "motors", setting->joint, names, "[[joint]]");
        const Joint* joint = find_joint(scene, setting->joint);
        if (joint != nullptr && !joint->motor)
        {
            checker.report(at, "motors", fmt::format("\"{}\" has no motor", setting->joint), "a joint with a motor");
        }
        const bool again = std::any_of(phase.motors.begin(), setting,
                                       [&](const MotorSetting& before) { return before.joint == setting->joint; });
        if (again) { checker.report(at, "motors", fmt::format("\"{}\" twice", setting->joint), "one setting each"); }
    }
}

void check_differential(const Scene& scene, const Joint& joint, const TableAt& at, Checker& checker)
{
    if (!checker.sound(at, {"joints"})) { return; }
    const std::vector<std::string> names = names_in(scene.joints);
    for (const std::string& name : joint.joints)
    {
        checker.require_known(at, "joints", name, names, "[[joint]]");
        const Joint* coupled = find_joint(scene, name);
        if (coupled == nullptr || coupled->type == JointType::revolute) { continue; }
        checker.report(at, "joints", fmt::format("\"{}\" is not revolute", name), "two revolute joints");
    }
    const Joint *one = find_joint(scene, joint.joints[0]), *other = find_joint(scene, joint.joints[1]);
    if (one == nullptr || other == nullptr) { return; }
    if (one == other) { checker.report(at, "joints", fmt::format("\"{}\" twice", one->name), "two joints"); }
    else if (one->between[0] != other->between[0] || one->axis != other->axis)
    {
        checker.report(at, "joints", "they have different first bodies or axes", "the same first body and axis");
    }
}

} // namespace

void validate_joints(const Scene& scene, Checker& checker)
{
    for (std::size_t b = 0; b < scene.bodies.size() && !scene.joints.empty(); ++b)
    {
        if (scene.bodies[b].name != world_side) { continue; }
        checker.report({"body", b}, "name", "\"world\" is what joints call the world", "another name");
    }
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
    {
        const Joint&  joint = scene.joints[i];
        const TableAt at{"joint", i};
        if (joint.type == JointType::differential) { check_differential(scene, joint, at, checker); }
        else { check_sides(scene, joint, at, checker); }
        check_geometry(joint, at, checker);
        check_motor(scene, joint, at, checker);
    }
    for (std::size_t i = 0; i < scene.phases.size(); ++i)
    {
        if (checker.sound({"phase", i}, {"motors"})) { check_settings(scene, scene.phases[i], {"phase", i}, checker); }
    }
}

} // namespace tread::scene
