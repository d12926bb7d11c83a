#pragma once

#include <array>
#include <vector>

#include "kernels/dem/joints/joint.hpp"

namespace tread::dem
{

/// Where a joint is at the start, world frame.
struct JointPlace
{
    std::array<Vec3<double>, 2> point; ///< m, of a and of b; they differ for a spring only
    Vec3<double>                axis;  ///< of any length but 0
};

/// Makes a joint without parts between two bodies (joint_world: the world) from their poses, given for all bodies.
Joint make_joint(JointKind kind, std::array<std::int32_t, 2> bodies, const JointPlace& place,
                 const std::vector<Vec3<double>>& positions, const std::vector<Quat>& orientations);

/// Makes the differential of two revolute joints, given by their indices.
Joint make_differential(std::array<std::int32_t, 2> revolutes);

/// Finds the joints whose rows depend on those of joints before them in the poses given, as in a loop that is closed
/// twice. Locked bodies count as free.
std::vector<std::size_t> dependent_joints(const std::vector<Joint>& joints, const std::vector<Vec3<double>>& positions,
                                          const std::vector<Quat>& orientations);

/// A direction of a body whose rate is prescribed: linear . v + angular . omega = rate.
struct GivenRate
{
    std::int32_t body;
    Vec3<double> linear;  ///< a unit vector, or 0
    Vec3<double> angular; ///< likewise; one of both is 0
    double       rate;    ///< m/s or rad/s
};

/// Finds the joints that given rates pull apart: a row of theirs depends on given directions and on rows before it, and
/// they give it a rate other than 0.
std::vector<std::size_t> joints_pulled_apart(const std::vector<Joint>&        joints,
                                             const std::vector<Vec3<double>>& positions,
                                             const std::vector<Quat>&         orientations,
                                             const std::vector<GivenRate>&    given);

} // namespace tread::dem
