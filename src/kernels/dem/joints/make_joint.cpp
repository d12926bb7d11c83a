#include "kernels/dem/joints/make_joint.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "kernels/dem/joints/joint_rows_kern.hpp"

namespace tread::dem
{
namespace
{

Joint blank(JointKind kind)
{
    Joint joint{};
    joint.kind = kind;
    for (int s = 0; s < 2; ++s)
    {
        joint.body[s]  = joint_world;
        joint.point[s] = Vec3<double>::Zero();
        joint.frame[s] = Quat::Identity();
    }
    return joint;
}

/// Rows of a joint's ties as written by write_rows.
std::vector<JointRow> tied_rows(const std::vector<Joint>& joints, std::size_t index, BodiesView bodies,
                                const std::vector<std::int32_t>& place)
{
    std::vector<Joint> bare = joints;
    for (Joint& joint : bare) { joint.first_row = 0; }
    bare[index].parts = 0;
    std::vector<JointRow>    rows(static_cast<std::size_t>(joint_rows::rows_of(bare[index])));
    std::vector<JointRecord> records(joints.size());
    JointsView               view;
    view.joint  = bare.data();
    view.place  = place.data();
    view.row    = rows.data();
    view.record = records.data();
    joint_rows::write_rows(view, bodies, static_cast<std::int64_t>(index), 1.0);
    return rows;
}

/// The row as a vector over all freedoms, of unit length.
Eigen::VectorXd direction_of(const JointRow& row, std::size_t bodies)
{
    Eigen::VectorXd vector = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * bodies));
    for (int s = 0; s < row.sides; ++s)
    {
        vector.segment<3>(6 * row.link[s]) += row.linear[s];
        vector.segment<3>(6 * row.link[s] + 3) += row.angular[s];
    }
    return vector / std::max(vector.norm(), joint_rows::least_length);
}

} // namespace

Joint make_joint(JointKind kind, std::array<std::int32_t, 2> bodies, const JointPlace& place,
                 const std::vector<Vec3<double>>& positions, const std::vector<Quat>& orientations)
{
    Joint      joint = blank(kind);
    const Quat frame = Quat::FromTwoVectors(Vec3<double>::UnitZ(), place.axis);
    for (std::size_t s = 0; s < 2; ++s)
    {
        const std::int32_t b = bodies[s];
        joint.body[s]        = b;
        joint.point[s]       = place.point[s];
        joint.frame[s]       = frame;
        if (b == joint_world) { continue; }
        const Quat inverse = orientations[static_cast<std::size_t>(b)].conjugate();
        joint.point[s]     = inverse * (place.point[s] - positions[static_cast<std::size_t>(b)]);
        joint.frame[s]     = inverse * frame;
    }
    return joint;
}

Joint make_differential(std::array<std::int32_t, 2> revolutes)
{
    Joint joint = blank(joint_differential);
    std::copy(revolutes.begin(), revolutes.end(), joint.couples);
    return joint;
}

/// Gram-Schmidt over the rows in order.
std::vector<std::size_t> dependent_joints(const std::vector<Joint>& joints, const std::vector<Vec3<double>>& positions,
                                          const std::vector<Quat>& orientations)
{
    constexpr double          independent = 1e-6; // sine of the angle between a row and those before it
    std::vector<Vec3<double>> position    = positions;
    std::vector<Quat>         orientation = orientations;
    std::vector<std::int32_t> place(positions.size());
    for (std::size_t b = 0; b < place.size(); ++b) { place[b] = static_cast<std::int32_t>(b); }
    BodiesView bodies{};
    bodies.position    = position.data();
    bodies.orientation = orientation.data();

    std::vector<Eigen::VectorXd> basis;
    std::vector<std::size_t>     dependent;
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        for (const JointRow& row : tied_rows(joints, j, bodies, place))
        {
            Eigen::VectorXd left = direction_of(row, positions.size());
            for (int pass = 0; pass < 2; ++pass)
            {
                for (const Eigen::VectorXd& known : basis) { left -= known.dot(left) * known; }
            }
            if (left.norm() > independent) { basis.push_back(left.normalized()); }
            else if (dependent.empty() || dependent.back() != j) { dependent.push_back(j); }
        }
    }
    return dependent;
}

} // namespace tread::dem
