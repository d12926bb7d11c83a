#include "world/joint_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "kernels/dem/joints/make_joint.hpp"
#include "scene/lines.hpp"

namespace tread::world
{
namespace
{

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a phase holds every body of a joint.
bool holds_joints(const scene::Phase& phase, const scene::Scene& scene)
{
    return std::all_of(scene.joints.begin(), scene.joints.end(),
                       [&](const scene::Joint& joint)
                       {
                           return joint.type == scene::JointType::differential ||
                                  std::all_of(joint.between.begin(), joint.between.end(),
                                              [&](const std::string& side)
                                              { return side == scene::world_side || contains(phase.hold, side); });
                       });
}

/// The rate that a held axis has at the end of its ramp, or the largest of its table.
double rate_of(const scene::AxisMotion& axis)
{
    if (axis.kind != scene::AxisKind::velocity) { return 0; }
    if (!axis.course.table) { return axis.course.value; }
    double largest = 0;
    for (const double value : axis.course.table->value)
    {
        if (std::abs(value) > std::abs(largest)) { largest = value; }
    }
    return largest;
}

/// What a phase gives the bodies of a scene as placed.
struct Rates
{
    const scene::Scene&         scene;
    const HostBodies&           bodies;
    std::vector<dem::GivenRate> given = {};

    void move(std::size_t b, const Vec3<double>& axis, double rate)
    {
        given.push_back({static_cast<std::int32_t>(b), axis, Vec3<double>::Zero(), rate});
    }
    void turn(std::size_t b, const Vec3<double>& axis, double rate)
    {
        given.push_back({static_cast<std::int32_t>(b), Vec3<double>::Zero(), axis, rate});
    }

    void add_held(std::size_t b)
    {
        for (int c = 0; c < 3; ++c)
        {
            move(b, Vec3<double>::Unit(c), 0);
            turn(b, Vec3<double>::Unit(c), 0);
        }
    }

    void add_locks(std::size_t b)
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            const Vec3<double> axis = Vec3<double>::Unit(static_cast<Eigen::Index>(c));
            if (contains(scene.bodies[b].lock, scene::translation_axes[c])) { move(b, axis, 0); }
            if (contains(scene.bodies[b].lock, scene::rotation_axes[c])) { turn(b, axis, 0); }
        }
    }

    void add_motion(std::size_t b, const scene::Motion& motion)
    {
        const auto is_given = [](const scene::AxisMotion& axis)
        { return axis.kind == scene::AxisKind::held || axis.kind == scene::AxisKind::velocity; };
        const Mat3<double> own = bodies.orientation[b].toRotationMatrix(), world = Mat3<double>::Identity();
        const Mat3<double>&frame = motion.frame == scene::MotionFrame::body ? own : world,
              &turn_frame        = motion.rotation_frame == scene::MotionFrame::body ? own : world;
        for (std::size_t c = 0; c < 3; ++c)
        {
            const auto  column = static_cast<Eigen::Index>(c);
            const auto &along = motion.translation[c], &about = motion.rotation[c];
            if (is_given(along)) { move(b, frame.col(column), rate_of(along)); }
            if (is_given(about)) { turn(b, turn_frame.col(column), rate_of(about)); }
        }
        if (is_given(motion.axle)) { turn(b, own.col(1), rate_of(motion.axle)); }
    }

    /// Bodies that are lowered or driven count as free.
    void add_phase(const scene::Phase& phase)
    {
        for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        {
            if (contains(phase.hold, scene.bodies[b].name)) { add_held(b); }
            else { add_locks(b); }
        }
        for (const scene::Motion& motion : phase.motion)
        {
            const auto at = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                         [&](const scene::Body& body) { return body.name == motion.body; });
            add_motion(static_cast<std::size_t>(at - scene.bodies.begin()), motion);
        }
    }
};

} // namespace

void require_consistent_motions(const scene::Scene& scene, const std::vector<dem::Joint>& joints,
                                const HostBodies& bodies)
{
    const auto                      named = static_cast<std::ptrdiff_t>(bodies.named);
    const std::vector<Vec3<double>> positions(bodies.position.begin(), bodies.position.begin() + named);
    const std::vector<Quat>         orientations(bodies.orientation.begin(), bodies.orientation.begin() + named);
    for (const scene::Phase& phase : scene.phases)
    {
        Rates rates{scene, bodies};
        rates.add_phase(phase);
        const auto apart = dem::joints_pulled_apart(joints, positions, orientations, rates.given);
        if (!apart.empty())
        {
            throw InputError(scene::line_of(scene, "phase." + phase.name) +
                             fmt::format("[[phase]] '{}': motion: it pulls [[joint]] '{}' apart: what it prescribes "
                                         "differs from what joints and other motions leave",
                                         phase.name, scene.joints[apart.front()].name));
        }
        if (!holds_joints(phase, scene)) { return; }
    }
}

} // namespace tread::world
