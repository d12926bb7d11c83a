#include "solver/bodies/body_joints.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "io/accept.hpp"
#include "solver/state_file.hpp"
#include "world/joints.hpp"

namespace tread::solver
{
namespace
{

void require_ties(double time, const scene::Joint& joint, const dem::JointRecord& record)
{
    if (std::max(record.gap, record.misalignment) <= joint.drift) { return; }
    throw NumericalError(fmt::format("t = {:.6g} s: joint '{}' has an error of {:.3g} m and {:.3g} rad, over its drift "
                                     "of {}: a smaller dt, more substeps, or a larger drift",
                                     time, joint.name, record.gap, record.misalignment, joint.drift));
}

/// A stop removes what its coordinate misses within a substep, as a tie does: the same drift bounds both.
void require_limits(double time, const scene::Joint& joint, const dem::JointRecord& record)
{
    if (std::abs(record.excess) <= joint.drift) { return; }
    const bool                slides = joint.limits.has_value();
    const scene::JointLimits& limits = slides ? *joint.limits : *joint.limits_deg;
    throw NumericalError(fmt::format(
        "t = {:.6g} s: joint '{}' is {:.3g} {} {} of its {}, over its drift of {}: motions that leave it within its "
        "limits, a smaller dt, more substeps, or a larger drift",
        time, joint.name, std::abs(record.excess), slides ? "m" : "rad",
        record.excess < 0 ? fmt::format("below the low end {}", limits[0])
                          : fmt::format("above the high end {}", limits[1]),
        slides ? "limits" : "limits_deg", joint.drift));
}

} // namespace

/// m, largest distance of a point of a joint's body from the joint's point; 0 for the world.
template<class Exec>
double BodyJoints<Exec>::radius(const dem::Joint& joint, int side) const
{
    if (joint.body[side] == dem::joint_world) { return 0; }
    const auto  body = static_cast<std::size_t>(joint.body[side]);
    const auto& form = world::template_of(world_, body);
    return form.bounding_radius * world_.bodies.scale[body] + joint.point[side].norm();
}

template<class Exec>
BodyJoints<Exec>::BodyJoints(const Exec& exec, const scene::Scene& scene, const world::World& world)
    : scene_(scene)
    , world_(world)
    , host_(world.joints)
    , phase_(scene.phases.size())
    , joints_(exec, host_, static_cast<std::int64_t>(world.bodies.size()))
    , coordinates_(host_.size(), 0)
{
}

/// m/s, largest speed that a joint's motor can give a point of its bodies.
template<class Exec>
double BodyJoints<Exec>::motor_speed(const dem::Joint& joint) const
{
    return std::abs(joint.speed) * std::max(radius(joint, 0), radius(joint, 1));
}

template<class Exec>
double BodyJoints<Exec>::begin_phase(std::size_t phase)
{
    if (phase == std::exchange(phase_, phase)) { return 0; }
    world::set_motors(scene_, phase, host_);
    joints_.update(host_);
    double largest = 0;
    for (const dem::Joint& joint : host_) { largest = std::max(largest, motor_speed(joint)); }
    return largest;
}

template<class Exec>
double BodyJoints<Exec>::set_motor(std::size_t joint, double speed, std::optional<double> most_torque)
{
    host_[joint].speed       = speed;
    host_[joint].most_effort = most_torque.value_or(host_[joint].most_effort);
    joints_.update(host_);
    return motor_speed(host_[joint]);
}

template<class Exec>
void BodyJoints<Exec>::check(double time) const
{
    const std::vector<dem::JointRecord> records = joints_.records();
    for (std::size_t j = 0; j < records.size(); ++j)
    {
        require_ties(time, scene_.joints[j], records[j]);
        require_limits(time, scene_.joints[j], records[j]);
    }
}

template<class Exec>
std::vector<JointRow> BodyJoints<Exec>::rows(double span) const
{
    const double          over = span > 0 ? 1 / span : 0;
    std::vector<JointRow> rows;
    for (const dem::JointRecord& record : joints_.records())
    {
        const double coordinate = span > 0 ? record.coordinate : coordinates_[rows.size()];
        rows.push_back({over * record.impulse, over * record.angular_impulse, over * record.motor_impulse, coordinate,
                        record.gap, record.misalignment, record.excess});
    }
    return rows;
}

template<class Exec>
void BodyJoints<Exec>::begin_mean()
{
    const std::vector<dem::JointRecord> records = joints_.records();
    std::transform(records.begin(), records.end(), coordinates_.begin(),
                   [](const dem::JointRecord& record) { return record.coordinate; });
    joints_.clear_records();
}

template<class Exec>
void BodyJoints<Exec>::transfer(StateFile& file)
{
    const auto rows  = static_cast<std::size_t>(joints_.states().size());
    const auto count = static_cast<std::size_t>(joints_.record().size());
    file.numbers("joints/phase", accept::number(phase_, 0, static_cast<double>(scene_.phases.size())));
    if (file.loads())
    {
        world::set_motors(scene_, phase_, host_);
        joints_.update(host_);
    }
    file.common("joints/states", joints_.states(),
                accept::all(accept::rows(rows), accept::within(0, dem::row_states - 1)));
    file.common("joints/records", joints_.record(), accept::all(accept::rows(count), accept::finite()));
}

#define TREAD_INSTANTIATE(Exec) template class BodyJoints<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
