#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/dem/joints/joints.hpp"
#include "scene/scene.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// State of one joint at one time. Force and torque are means since the last row.
struct JointRow
{
    Vec3<double> force;        ///< N, on the second body, world frame
    Vec3<double> torque;       ///< N m, likewise, about the joint's point
    double       motor_torque; ///< N m; of a differential: its torque on both axes
    double       coordinate;   ///< m or rad
    double       gap;          ///< m, largest since the last row
    double       misalignment; ///< rad, likewise
    double       excess;       ///< m or rad, farthest beyond a limit, likewise; negative: below the low one
};

/// Joints of a scene on one backend. On several ranks every rank solves all of them, with the same bits.
template<class Exec>
class BodyJoints
{
public:
    BodyJoints(const Exec& exec, const scene::Scene& scene, const world::World& world);

    dem::JointsView view() { return joints_.view(); }

    /// Indices of the bodies with joints, ascending.
    const std::vector<std::int32_t>& bodies() const { return joints_.bodies(); }

    /// Sets the motors to the speeds of a phase of the scene. Returns the largest speed (m/s) that a motor can give a
    /// point of its bodies, if the phase has changed; else 0.
    double begin_phase(std::size_t phase);

    /// Sets the speed (rad/s) and the largest torque (N m; empty: as before) of a joint's motor until the next phase;
    /// returns the largest speed (m/s) that it can give a point of its bodies.
    double set_motor(std::size_t joint, double speed, std::optional<double> most_torque);

    /// Throws NumericalError if a joint's error, or its way beyond a limit, exceeds its drift; `time` (s) is for that
    /// message. Synchronises.
    void check(double time) const;

    /// Returns the rows of all joints over `span` (s) since begin_mean().
    std::vector<JointRow> rows(double span) const;
    void                  begin_mean();

    void transfer(StateFile& file);

private:
    double radius(const dem::Joint& joint, int side) const;
    double motor_speed(const dem::Joint& joint) const;

    const scene::Scene&     scene_;
    const world::World&     world_;
    std::vector<dem::Joint> host_;
    std::size_t             phase_; ///< number of phases: none has begun
    dem::Joints<Exec>       joints_;
    std::vector<double>     coordinates_; ///< at begin_mean(), m or rad
};

} // namespace tread::solver
