#include "world/joints.hpp"

#include <numbers>
#include <string>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "kernels/dem/joints/make_joint.hpp"
#include "scene/lines.hpp"
#include "scene/named.hpp"
#include "world/joint_motions.hpp"

namespace tread::world
{
namespace
{

constexpr double degree = std::numbers::pi / 180;

/// Index of the joint of this name; the scene was validated.
std::int32_t joint_index(const scene::Scene& scene, const std::string& name)
{
    return static_cast<std::int32_t>(scene::index_of(scene.joints, name));
}

std::int32_t side_of(const scene::Scene& scene, const std::string& name)
{
    if (name == scene::world_side) { return dem::joint_world; }
    return static_cast<std::int32_t>(scene::index_of(scene.bodies, name));
}

Vec3<double> vector(const std::array<double, 3>& values) { return {values[0], values[1], values[2]}; }

dem::JointKind kind_of(scene::JointType type)
{
    switch (type)
    {
    case scene::JointType::revolute:
        return dem::joint_revolute;
    case scene::JointType::prismatic:
        return dem::joint_prismatic;
    case scene::JointType::spherical:
        return dem::joint_spherical;
    case scene::JointType::fixed:
        return dem::joint_fixed;
    case scene::JointType::differential:
        return dem::joint_differential;
    case scene::JointType::spring:
        break;
    }
    return dem::joint_spring;
}

/// Adds spring, motor and limits to a joint.
void add_parts(const scene::Joint& from, dem::Joint& joint)
{
    if (from.stiffness || from.damping)
    {
        joint.parts |= dem::joint_has_spring;
        joint.stiffness = from.stiffness.value_or(0);
        joint.damping   = from.damping.value_or(0);
    }
    if (from.type == scene::JointType::spring)
    {
        joint.rest = from.length.value_or((vector(from.to) - vector(from.at)).norm());
    }
    if (from.limits || from.limits_deg)
    {
        joint.parts |= dem::joint_has_limits;
        const scene::JointLimits limits = from.limits ? *from.limits : *from.limits_deg;
        const double             unit   = from.limits ? 1 : degree;
        joint.low                       = unit * limits[0];
        joint.high                      = unit * limits[1];
    }
    if (from.motor)
    {
        joint.parts |= dem::joint_has_motor;
        joint.gain = from.motor->gain.value_or(0);
    }
}

dem::Joint make(const scene::Scene& scene, const scene::Joint& from, const HostBodies& bodies)
{
    if (from.type == scene::JointType::differential)
    {
        return dem::make_differential({joint_index(scene, from.joints[0]), joint_index(scene, from.joints[1])});
    }
    const bool            spring = from.type == scene::JointType::spring;
    const bool            axial  = from.type == scene::JointType::revolute || from.type == scene::JointType::prismatic;
    const dem::JointPlace place{{vector(from.at), vector(spring ? from.to : from.at)},
                                axial ? vector(from.axis) : Vec3<double>::UnitZ()};
    dem::Joint            joint =
        dem::make_joint(kind_of(from.type), {side_of(scene, from.between[0]), side_of(scene, from.between[1])}, place,
                        bodies.position, bodies.orientation);
    add_parts(from, joint);
    return joint;
}

/// Throws if a row of a joint depends on those of joints before it.
void require_independent(const scene::Scene& scene, const std::vector<dem::Joint>& joints, const HostBodies& bodies)
{
    const auto named     = static_cast<std::ptrdiff_t>(bodies.named);
    const auto dependent = dem::dependent_joints(joints, {bodies.position.begin(), bodies.position.begin() + named},
                                                 {bodies.orientation.begin(), bodies.orientation.begin() + named});
    if (dependent.empty()) { return; }
    const scene::Joint& joint = scene.joints[dependent.front()];
    const char*         key   = joint.type == scene::JointType::differential ? "joints" : "between";
    throw InputError(scene::line_of(scene, "joint." + joint.name) +
                     fmt::format("[[joint]] '{}': {}: it ties what joints before it tie already, so that their forces "
                                 "are not determined; in a plane loop make two of the joints spherical",
                                 joint.name, key));
}

} // namespace

std::vector<dem::Joint> make_joints(const scene::Scene& scene, const HostBodies& bodies)
{
    std::vector<dem::Joint> joints;
    joints.reserve(scene.joints.size());
    for (const scene::Joint& joint : scene.joints) { joints.push_back(make(scene, joint, bodies)); }
    require_independent(scene, joints, bodies);
    require_consistent_motions(scene, joints, bodies);
    set_motors(scene, 0, joints);
    return joints;
}

void set_motors(const scene::Scene& scene, std::size_t phase, std::vector<dem::Joint>& joints)
{
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        const auto& motor = scene.joints[j].motor;
        if (!motor) { continue; }
        const bool begun      = motor->from.empty() || phase >= scene::index_of(scene.phases, motor->from);
        joints[j].speed       = begun ? motor->speed : 0;
        joints[j].most_effort = motor->max_torque;
    }
    for (std::size_t p = 0; p < std::min(phase + 1, scene.phases.size()); ++p)
    {
        for (const scene::MotorSetting& setting : scene.phases[p].motors)
        {
            dem::Joint& joint = joints[scene::index_of(scene.joints, setting.joint)];
            joint.speed       = setting.speed;
            joint.most_effort = setting.max_torque.value_or(joint.most_effort);
        }
    }
}

} // namespace tread::world
