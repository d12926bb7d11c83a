#include "kernels/dem/joints/make_joint.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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

constexpr double independent = 1e-6; ///< sine of the angle between a row and those before it

/// Directions of all freedoms and their rates, by Gram-Schmidt.
struct KnownRates
{
    std::vector<Eigen::VectorXd> direction; ///< orthonormal
    std::vector<double>          rate;

    /// Adds a direction of unit length with its rate, if it is independent of those before. If not, returns what the
    /// rate differs by from that which they give it.
    std::optional<double> add(Eigen::VectorXd left, double wanted)
    {
        for (int pass = 0; pass < 2; ++pass)
        {
            for (std::size_t k = 0; k < direction.size(); ++k)
            {
                const double share = direction[k].dot(left);
                left -= share * direction[k];
                wanted -= share * rate[k];
            }
        }
        const double length = left.norm();
        if (length <= independent) { return wanted; }
        direction.emplace_back(left / length);
        rate.push_back(wanted / length);
        return {};
    }
};

/// Calls visit(joint, direction of unit length) for each row of the joints' ties.
template<class Visit>
void for_each_tie(const std::vector<Joint>& joints, std::vector<Vec3<double>> positions, std::vector<Quat> orientations,
                  Visit visit)
{
    std::vector<std::int32_t> place(positions.size());
    for (std::size_t b = 0; b < place.size(); ++b) { place[b] = static_cast<std::int32_t>(b); }
    BodiesView bodies{};
    bodies.position    = positions.data();
    bodies.orientation = orientations.data();
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        for (const JointRow& row : tied_rows(joints, j, bodies, place)) { visit(j, direction_of(row, place.size())); }
    }
}

void add_once(std::vector<std::size_t>& list, std::size_t joint)
{
    if (list.empty() || list.back() != joint) { list.push_back(joint); }
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

std::vector<std::size_t> dependent_joints(const std::vector<Joint>& joints, const std::vector<Vec3<double>>& positions,
                                          const std::vector<Quat>& orientations)
{
    KnownRates               known;
    std::vector<std::size_t> dependent;
    for_each_tie(joints, positions, orientations,
                 [&](std::size_t j, const Eigen::VectorXd& direction)
                 {
                     if (known.add(direction, 0)) { add_once(dependent, j); }
                 });
    return dependent;
}

std::vector<std::size_t> joints_pulled_apart(const std::vector<Joint>&        joints,
                                             const std::vector<Vec3<double>>& positions,
                                             const std::vector<Quat>& orientations, const std::vector<GivenRate>& given)
{
    KnownRates known;
    double     largest = 0;
    for (const GivenRate& one : given)
    {
        Eigen::VectorXd direction              = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * positions.size()));
        direction.segment<3>(6 * one.body)     = one.linear;
        direction.segment<3>(6 * one.body + 3) = one.angular;
        known.add(direction, one.rate);
        largest = std::max(largest, std::abs(one.rate));
    }
    std::vector<std::size_t> apart;
    for_each_tie(joints, positions, orientations,
                 [&](std::size_t j, const Eigen::VectorXd& direction)
                 {
                     const std::optional<double> off = known.add(direction, 0);
                     if (off && std::abs(*off) > independent * largest) { add_once(apart, j); }
                 });
    return apart;
}

} // namespace tread::dem
