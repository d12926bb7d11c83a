#pragma once

#include "kernels/dem/joints/joint_motion_kern.hpp"
#include "kernels/dem/joints/joint_rows_kern.hpp"
#include "kernels/dem/joints/joint_solve_kern.hpp"
#include "kernels/dem/joints/joints.hpp"
#include "kernels/dem/motion/move_impl.hpp"

// One substep of all joints by one team of lanes; joints.cpp and joints.cu provide the team.
namespace tread::dem::joint_steps
{

/// Sums the forces on the jointed bodies, solves the joints, and leaves a wrench for each body and a record for each
/// joint.
struct SolveJoints
{
    BodiesView         bodies;
    PairsView          pairs; ///< first = null: pairs were never found
    Vec3<double>       gravity;
    double             dt;
    moving::SumOutside outside;
    SharedView         shared;
    JointsView         joints;
    PrescribedView     motions; ///< empty in a scene without motions

    /// `factor`: as joint_solve::solve takes it.
    template<class Team>
    TREAD_HD void operator()(double* factor, const Team& team) const
    {
        for (std::int64_t k = team.group(); k < joints.link_count; k += team.groups()) { free_link(k, team.members()); }
        // The last lanes: the first ones have the links to do.
        for (std::int64_t j = team.lanes() - 1 - team.lane(); j < joints.joint_count; j += team.lanes())
        {
            joint_rows::write_rows(joints, bodies, j, dt);
        }
        team.sync();
        for (std::int64_t r = team.lane(); r < joints.row_count; r += team.lanes())
        {
            joint_solve::respond(joints, joints.row[r]);
        }
        team.sync();
        joint_solve::solve(joints, {factor}, team);
        for (std::int64_t k = team.group(); k < joints.link_count; k += team.groups())
        {
            write_wrench(k, team.members());
        }
        for (std::int64_t j = team.lanes() - 1 - team.lane(); j < joints.joint_count; j += team.lanes())
        {
            add_to_record(j);
        }
    }

private:
    template<class Lanes>
    TREAD_HD void free_link(std::int64_t k, const Lanes& lanes) const
    {
        const std::int64_t      b = joints.body[k];
        const moving::BodyShare share =
            pairs.first != nullptr ? moving::GatherPairs{pairs, bodies.count}(b, lanes) : moving::BodyShare::zero();
        WrenchShare acting{outside(b, lanes), share.contact};
        if (lanes.lane() != 0) { return; }
        if (shared.is_shared(b)) { acting = wrench_of(shared, shared.place[b]); }
        const ContactWrench contact = acting.outside + acting.pairs;
        const Vec3<double>  pull    = bodies.acting_weight(b, bodies.locked[b]) * gravity;
        const bool          moved   = (bodies.locked[b] & prescribed) != 0;
        joints.link[k] = moved ? joint_solve::prescribed_motion(bodies, b, motions.motion[b], contact, pull, dt)
                               : joint_solve::free_motion(bodies, b, contact, pull, dt);
    }

    /// Sums the impulses on a body.
    template<class Lanes>
    TREAD_HD void write_wrench(std::int64_t k, const Lanes& lanes) const
    {
        JointWrench sum{Vec3<double>::Zero(), Vec3<double>::Zero(), Vec3<double>::Zero(), Vec3<double>::Zero()};
        joint_solve::for_each_of(joints.rows_of_link, k, lanes,
                                 [&](std::int32_t r)
                                 {
                                     const JointRow& row = joints.row[r];
                                     for (int s = 0; s < row.sides; ++s)
                                     {
                                         if (row.link[s] == k) { add_to_wrench(row, s, sum); }
                                     }
                                 });
        moving::reduce(sum.force, lanes);
        moving::reduce(sum.torque, lanes);
        moving::reduce(sum.working_force, lanes);
        moving::reduce(sum.working_torque, lanes);
        if (lanes.lane() == 0) { joints.wrench[k] = sum; }
    }

    TREAD_HD void add_to_wrench(const JointRow& row, int side, JointWrench& sum) const
    {
        const Vec3<double> force  = row.impulse / dt * row.linear[side];
        const Vec3<double> torque = row.impulse / dt * row.angular[side];
        sum.force += force;
        sum.torque += torque;
        if (row.works == 0) { return; }
        sum.working_force += force;
        sum.working_torque += torque;
    }

    /// Adds the impulses of a joint's rows to its record. On the world as b they are the reaction of those on a.
    TREAD_HD void add_to_record(std::int64_t j) const
    {
        const Joint& joint  = joints.joint[j];
        JointRecord& record = joints.record[j];
        if (joint.kind == joint_differential)
        {
            record.motor_impulse += joints.row[joint.first_row].impulse;
            return;
        }
        const bool             on_world = joint.body[1] == joint_world;
        const std::int32_t     link     = joints.place[joint.body[on_world ? 0 : 1]];
        const double           sign     = on_world ? -1 : 1;
        const joint_rows::Side side     = joint_rows::side_of(joint, on_world ? 0 : 1, bodies);
        Vec3<double>           impulse = Vec3<double>::Zero(), twist = Vec3<double>::Zero();
        std::int32_t           r = joint.first_row;
        for (const std::int32_t end = r + joint.row_count; r < end; ++r)
        {
            const JointRow& row = joints.row[r];
            for (int s = 0; s < row.sides; ++s)
            {
                if (row.link[s] != link) { continue; }
                const Vec3<double> of_row = sign * row.impulse * row.linear[s];
                impulse += of_row;
                twist += sign * row.impulse * row.angular[s] - side.lever.cross(of_row);
            }
        }
        record.impulse += impulse;
        record.angular_impulse += twist;
        const std::int32_t limits = (joint.parts & joint_has_limits) != 0 ? 2 : 0;
        if ((joint.parts & joint_has_motor) != 0) { record.motor_impulse += joints.row[r - limits - 1].impulse; }
    }
};

/// Makes the SolveJoints of the step.
template<class Exec>
SolveJoints make_solve(const BodyStep<Exec>& step)
{
    return {step.bodies,           step.pairs.view(), step.motion.gravity, step.motion.dt,
            {step.motion.outside}, step.shared,       step.joints,         step.prescribed};
}

} // namespace tread::dem::joint_steps
