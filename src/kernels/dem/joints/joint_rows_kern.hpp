#pragma once

#include <cmath>

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/joints/joint_rows.hpp"

// Rows of one joint at the start of a substep. A tied direction gets a row that removes its error within the substep:
// rate = -error / dt. Springs are implicit in their own coordinate, hence stable at any stiffness.
namespace tread::dem::joint_rows
{

/// Share of its speed that a motor may miss under load: a motor that runs against a stop then finds its largest effort.
inline constexpr double motor_slack = 1e-6;

inline constexpr double least_length = 1e-12; ///< m; a shorter spring has no direction and no force

/// One side of a joint, in the world's frame.
struct Side
{
    Vec3<double> point; ///< m
    Vec3<double> lever; ///< m, from the body's centre; 0 for the world
    Mat3<double> frame; ///< axes of the joint as columns
};

TREAD_HD Side side_of(const Joint& joint, int s, const BodiesView& bodies)
{
    const std::int32_t b = joint.body[s];
    if (b == joint_world) { return {joint.point[s], Vec3<double>::Zero(), joint.frame[s].toRotationMatrix()}; }
    const Mat3<double> turn  = bodies.orientation[b].toRotationMatrix();
    const Vec3<double> lever = turn * joint.point[s];
    return {bodies.position[b] + lever, lever, turn * joint.frame[s].toRotationMatrix()};
}

/// Adds a body to a row; a body that the row has already gets one entry.
TREAD_HD void add_side(JointRow& row, std::int32_t link, const Vec3<double>& linear, const Vec3<double>& angular)
{
    for (int s = 0; s < row.sides; ++s)
    {
        if (row.link[s] != link) { continue; }
        row.linear[s] += linear;
        row.angular[s] += angular;
        return;
    }
    row.link[row.sides]    = link;
    row.linear[row.sides]  = linear;
    row.angular[row.sides] = angular;
    ++row.sides;
}

TREAD_HD void clear(JointRow& row)
{
    row.sides             = 0;
    row.softness          = 0;
    row.relative_softness = 0;
    row.low               = -INFINITY;
    row.high              = INFINITY;
    row.impulse           = 0;
    row.works             = 0;
    row.skipped           = 0;
}

/// Writes the rows of one joint.
struct RowWriter
{
    JointsView        joints;
    const BodiesView& bodies;
    const Joint&      joint;
    double            dt; ///< s
    Side              a, b;
    Vec3<double>      offset; ///< m, from the point of a to that of b
    std::int32_t      next;
    double            gap2          = 0; ///< m2
    double            misalignment2 = 0; ///< rad2
    double            excess        = 0; ///< m or rad, of the coordinate beyond its limits

    TREAD_HD RowWriter(const JointsView& all, const BodiesView& in, const Joint& one, double step)
        : joints(all)
        , bodies(in)
        , joint(one)
        , dt(step)
        , a(side_of(one, 0, in))
        , b(side_of(one, 1, in))
        , offset(b.point - a.point)
        , next(one.first_row)
    {
    }

    TREAD_HD void add(JointRow& row, const Joint& of, int side, const Vec3<double>& linear,
                      const Vec3<double>& angular) const
    {
        if (of.body[side] != joint_world) { add_side(row, joints.place[of.body[side]], linear, angular); }
    }

    /// Row of the displacement of b's point along n, which turns with a.
    TREAD_HD JointRow& along(const Vec3<double>& n)
    {
        JointRow& row = joints.row[next++];
        clear(row);
        add(row, joint, 0, -n, -(a.lever + offset).cross(n));
        add(row, joint, 1, n, b.lever.cross(n));
        return row;
    }

    /// Row of the rotation of b relative to a about n.
    TREAD_HD JointRow& about(const Vec3<double>& n)
    {
        JointRow& row = joints.row[next++];
        clear(row);
        add(row, joint, 0, Vec3<double>::Zero(), -n);
        add(row, joint, 1, Vec3<double>::Zero(), n);
        return row;
    }

    TREAD_HD void tie_point(int directions)
    {
        for (int c = 0; c < directions; ++c)
        {
            const Vec3<double> n     = a.frame.col(c);
            const double       error = n.dot(offset);
            along(n).target          = -error / dt;
            gap2 += error * error;
        }
    }

    /// Ties the axis of b to that of a.
    TREAD_HD void tie_axis()
    {
        for (int c = 0; c < 2; ++c)
        {
            const Vec3<double> t = a.frame.col(c), z = b.frame.col(2);
            const double       error = t.dot(z);
            about(z.cross(t)).target = -error / dt;
            misalignment2 += error * error;
        }
    }

    /// Ties all axes of b to those of a. The error is the vector of a small rotation.
    TREAD_HD void tie_frame()
    {
        Vec3<double> error = Vec3<double>::Zero();
        for (int c = 0; c < 3; ++c)
        {
            const Vec3<double> of_a = a.frame.col(c), of_b = b.frame.col(c);
            error += 0.5 * of_a.cross(of_b);
        }
        for (int c = 0; c < 3; ++c)
        {
            const Vec3<double> n = a.frame.col(c);
            about(n).target      = -n.dot(error) / dt;
        }
        misalignment2 += error.squaredNorm();
    }

    TREAD_HD JointRow& free_row(const Vec3<double>& direction)
    {
        JointRow& row = joint.kind == joint_revolute ? about(direction) : along(direction);
        row.works     = 1;
        return row;
    }

    /// Rows of the parts along `direction`, in which the coordinate increases.
    TREAD_HD void add_parts(const Vec3<double>& direction, double coordinate)
    {
        if ((joint.parts & joint_has_spring) != 0)
        {
            const double implicit = joint.damping + dt * joint.stiffness;
            JointRow&    row      = free_row(direction);
            row.softness          = 1 / (dt * implicit);
            row.target            = joint.stiffness * (joint.rest - coordinate) / implicit;
        }
        if ((joint.parts & joint_has_motor) != 0)
        {
            JointRow& row         = free_row(direction);
            row.target            = joint.speed;
            row.softness          = joint.gain > 0 ? 1 / (dt * joint.gain) : 0;
            row.relative_softness = motor_slack;
            row.low               = -dt * joint.most_effort;
            row.high              = dt * joint.most_effort;
        }
        if ((joint.parts & joint_has_limits) != 0)
        {
            JointRow& low  = free_row(direction);
            low.target     = (joint.low - coordinate) / dt;
            low.low        = 0;
            JointRow& high = free_row(-direction);
            high.target    = (coordinate - joint.high) / dt;
            high.low       = 0;
            excess         = coordinate - std::fmin(std::fmax(coordinate, joint.low), joint.high);
        }
    }
};

/// rad, rotation of b relative to a about the joint's z axis.
TREAD_HD double angle_of(const Side& a, const Side& b)
{
    const Vec3<double> x = b.frame.col(0);
    return std::atan2(x.dot(a.frame.col(1)), x.dot(a.frame.col(0)));
}

TREAD_HD void write_differential(RowWriter& writer)
{
    JointRow& row = writer.joints.row[writer.next++];
    clear(row);
    double sum = 0;
    for (const std::int32_t coupled : writer.joint.couples)
    {
        const Joint&       joint = writer.joints.joint[coupled];
        const Side         a = side_of(joint, 0, writer.bodies), b = side_of(joint, 1, writer.bodies);
        const Vec3<double> axis = a.frame.col(2);
        writer.add(row, joint, 0, Vec3<double>::Zero(), -axis);
        writer.add(row, joint, 1, Vec3<double>::Zero(), axis);
        sum += angle_of(a, b);
    }
    row.target           = -sum / writer.dt;
    writer.misalignment2 = sum * sum;
}

/// Writes all rows of a joint and updates its coordinate and largest errors.
TREAD_HD void write_rows(const JointsView& joints, const BodiesView& bodies, std::int64_t j, double dt)
{
    const Joint& joint  = joints.joint[j];
    JointRecord& record = joints.record[j];
    RowWriter    writer(joints, bodies, joint, dt);
    if (joint.kind == joint_differential) { write_differential(writer); }
    else if (joint.kind == joint_spring)
    {
        record.coordinate = writer.offset.norm();
        writer.add_parts(writer.offset / std::fmax(record.coordinate, least_length), record.coordinate);
    }
    else if (joint.kind == joint_prismatic)
    {
        writer.tie_point(2);
        writer.tie_frame();
        record.coordinate = writer.offset.dot(writer.a.frame.col(2));
        writer.add_parts(writer.a.frame.col(2), record.coordinate);
    }
    else
    {
        writer.tie_point(3);
        if (joint.kind == joint_fixed) { writer.tie_frame(); }
        if (joint.kind == joint_revolute)
        {
            writer.tie_axis();
            record.coordinate = angle_of(writer.a, writer.b);
            writer.add_parts(writer.a.frame.col(2), record.coordinate);
        }
    }
    record.gap          = std::fmax(record.gap, std::sqrt(writer.gap2));
    record.misalignment = std::fmax(record.misalignment, std::sqrt(writer.misalignment2));
    if (std::fabs(writer.excess) > std::fabs(record.excess)) { record.excess = writer.excess; }
}

/// Number of rows that write_rows makes.
TREAD_HD std::int32_t rows_of(const Joint& joint)
{
    constexpr std::int32_t tied[] = {5, 5, 3, 6, 1, 0}; // by JointKind
    return tied[joint.kind] + ((joint.parts & joint_has_spring) != 0 ? 1 : 0) +
           ((joint.parts & joint_has_motor) != 0 ? 1 : 0) + ((joint.parts & joint_has_limits) != 0 ? 2 : 0);
}

} // namespace tread::dem::joint_rows
