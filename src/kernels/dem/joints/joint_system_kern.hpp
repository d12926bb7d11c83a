#pragma once

#include "kernels/dem/joints/joint_rows.hpp"

// The system of the joints' rows: its entries, its factor L D L^T, joint by joint in the levels of a plan
// (elimination.hpp), and its solution. A team of lanes works together; lanes are in groups that share one item.
namespace tread::dem::joint_solve
{

/// Pivots below this share of a row's diagonal mean that the row depends on rows before it.
inline constexpr double least_pivot = 1e-9;

inline constexpr int most_rows = 9; ///< of a joint: five ties, spring, motor, two limits

/// Calls f(item) for the items of list k, which the lanes share.
template<class Lanes, class F>
TREAD_HD void for_each_of(const IndexListsView& lists, std::int64_t k, const Lanes& lanes, F f)
{
    for (std::int64_t i = lists.first[k] + lanes.lane(); i < lists.first[k + 1]; i += lanes.lanes())
    {
        f(lists.item[i]);
    }
}

TREAD_HD double rate_of(const JointRow& row, const JointLink* links)
{
    double rate = 0;
    for (int s = 0; s < row.sides; ++s)
    {
        const JointLink& link = links[row.link[s]];
        rate += row.linear[s].dot(link.velocity) + row.angular[s].dot(link.angular_velocity);
    }
    return rate;
}

/// Change of row i's rate by a unit impulse of row j.
TREAD_HD double coupling_of(const JointRow& i, const JointRow& j)
{
    double sum = 0;
    for (int s = 0; s < i.sides; ++s)
    {
        for (int t = 0; t < j.sides; ++t)
        {
            if (i.link[s] != j.link[t]) { continue; }
            sum += i.linear[s].dot(j.linear_response[t]) + i.angular[s].dot(j.angular_response[t]);
        }
    }
    return sum;
}

/// Lower triangle of the system, row by row, with the right-hand side as its last row. Eliminated columns hold L D
/// below the diagonal; on it, the inverse of the pivot, or 0 for a row that depends on rows before it or is at a bound.
struct Triangle
{
    double* value;

    TREAD_HD double& operator()(std::int32_t row, std::int32_t column) const
    {
        return value[row * (row + 1) / 2 + column];
    }
};

/// A joint's rows, and those that its elimination changes.
struct JointBlock
{
    std::int32_t        first, end; ///< its own rows
    const std::int32_t* below;
    std::int32_t        below_count;
    std::int32_t        right; ///< row of the right-hand side

    /// Row c of its own, or the last: loops over all that a joint may have read without branches.
    TREAD_HD std::int32_t own(std::int32_t c) const { return first + c < end ? first + c : end - 1; }
    TREAD_HD std::int32_t count() const { return end - first; }

    /// Row q of those below its own, the right-hand side last.
    TREAD_HD std::int32_t other(std::int32_t q) const { return q < below_count ? below[q] : right; }
    TREAD_HD std::int32_t others() const { return below_count + 1; }
};

TREAD_HD JointBlock block_of(const JointsView& joints, std::int32_t j)
{
    const Joint& joint = joints.joint[j];
    return {joint.first_row, joint.first_row + joint.row_count, joints.below.item + joints.below.first[j],
            joints.below.first[j + 1] - joints.below.first[j], static_cast<std::int32_t>(joints.row_count)};
}

/// Writes the columns of a joint; rows at a bound are empty.
template<class Lanes>
TREAD_HD void write_columns(const JointsView& joints, const Triangle& system, const JointBlock& block,
                            const Lanes& lanes)
{
    const std::int32_t own = block.end - block.first, rows = own + block.below_count;
    for (std::int32_t entry = lanes.lane(); entry < own * rows; entry += lanes.lanes())
    {
        const std::int32_t q = entry / own, column = block.first + entry % own;
        const std::int32_t row = q < own ? block.first + q : block.below[q - own];
        if (row < column || joints.state[row] != row_solved || joints.state[column] != row_solved) { continue; }
        const double coupling = coupling_of(joints.row[row], joints.row[column]);
        system(row, column)   = row == column ? coupling + joints.row[row].softness : coupling;
    }
    for (std::int32_t column = block.first + lanes.lane(); column < block.end; column += lanes.lanes())
    {
        if (joints.state[column] != row_solved) { continue; }
        system(block.right, column) = joints.row[column].target - rate_of(joints.row[column], joints.moved);
    }
}

/// Eliminates the columns of a joint from its own rows and those that meet it. A lane has a row's entries in registers,
/// column by column: it publishes one, and reads those that the joint's own rows have published. Entries behind a
/// row's end are computed and not used.
template<class Lanes>
TREAD_HD void eliminate_columns(const JointsView& joints, const Triangle& factor, const JointBlock& block,
                                const Lanes& lanes)
{
    const std::int32_t own = block.count(), rows = own + block.others();
    for (std::int32_t before = 0; before < rows; before += lanes.lanes())
    {
        const std::int32_t q    = before + lanes.lane();
        const std::int32_t last = q >= rows ? -1 : q < own ? q : own - 1; // column of the block that the row ends with
        const std::int32_t row  = q >= rows ? block.right : q < own ? block.first + q : block.other(q - own);
        const double       dependent = q < own ? least_pivot * joints.row[row].diagonal : 0.0;
        double             entry[most_rows];
        for (std::int32_t c = 0; c < most_rows; ++c)
        {
            entry[c] = factor(row, c <= last ? block.first + c : block.first);
        }
        for (std::int32_t c = 0; c < most_rows; ++c)
        {
            if (c >= own) { break; }
            const std::int32_t column = block.first + c;
            if (c == q) { factor(row, column) = entry[c] > dependent ? 1 / entry[c] : 0.0; }
            else if (c <= last) { factor(row, column) = entry[c]; }
            lanes.sync();
            const double share = entry[c] * factor(column, column);
            for (std::int32_t d = c + 1; d < most_rows; ++d) { entry[d] -= share * factor(block.own(d), column); }
        }
    }
}

/// Subtracts from row t of a level's targets what the elimination of the level's joints changes in it.
template<class Lanes>
TREAD_HD void update_row(const JointsView& joints, const Triangle& factor, std::int64_t t, const Lanes& lanes)
{
    const std::int32_t row = joints.targets.item[t];
    for (std::int32_t i = joints.changed_by.first[t]; i < joints.changed_by.first[t + 1]; ++i)
    {
        const JointBlock block = block_of(joints, joints.changed_by.item[i]);
        for (std::int32_t q = lanes.lane(); q < block.below_count && block.below[q] <= row; q += lanes.lanes())
        {
            const std::int32_t column = block.below[q];
            double             sum    = 0;
            for (std::int32_t c = 0; c < most_rows; ++c)
            {
                const std::int32_t k     = block.own(c);
                const double       share = factor(row, k) * factor(column, k) * factor(k, k);
                sum += c < block.count() ? share : 0.0;
            }
            factor(row, column) -= sum;
        }
        lanes.sync(); // the next joint may have the column in another lane
    }
}

/// Replaces the right-hand side of a joint's rows by their solution, after those of all rows below.
template<class Lanes>
TREAD_HD void substitute(const Triangle& factor, const JointBlock& block, const Lanes& lanes)
{
    double known[most_rows]{};
    for (std::int32_t q = lanes.lane(); q < block.below_count; q += lanes.lanes())
    {
        const std::int32_t row    = block.below[q];
        const double       solved = factor(block.right, row);
        for (std::int32_t c = 0; c < most_rows; ++c) { known[c] += factor(row, block.own(c)) * solved; }
    }
    for (double& sum : known) { sum = lanes.sum(sum); }
    if (lanes.lane() != 0) { return; }
    double solution[most_rows]{};
    for (std::int32_t c = most_rows - 1; c >= 0; --c)
    {
        const std::int32_t column = block.own(c);
        for (std::int32_t d = c + 1; d < most_rows; ++d) { known[c] += factor(block.own(d), column) * solution[d]; }
        const double solved = factor(column, column) * (factor(block.right, column) - known[c]);
        solution[c]         = c < block.count() ? solved : 0.0;
    }
    for (std::int32_t c = 0; c < block.count(); ++c) { factor(block.right, block.first + c) = solution[c]; }
}

/// Calls f(block) for the joints of a level, a group of lanes each.
template<class Team, class F>
TREAD_HD void for_each_block_of(const JointsView& joints, std::int64_t level, const Team& team, F f)
{
    for (std::int64_t at = joints.levels.first[level] + team.group(); at < joints.levels.first[level + 1];
         at += team.groups())
    {
        f(block_of(joints, joints.levels.item[at]));
    }
}

/// Writes the system, eliminates its rows level by level, and leaves the solution as the last row. `factor` has room
/// for factor_size(row_count) values.
template<class Team>
TREAD_HD void solve_system(const JointsView& joints, const Triangle& factor, const Team& team)
{
    const auto lanes = team.members();
    for (std::int64_t i = team.lane(); i < factor_size(joints.row_count); i += team.lanes()) { factor.value[i] = 0; }
    team.sync();
    for (std::int64_t j = team.group(); j < joints.joint_count; j += team.groups())
    {
        write_columns(joints, factor, block_of(joints, static_cast<std::int32_t>(j)), lanes);
    }
    team.sync();
    for (std::int64_t level = 0; level < joints.level_count; ++level)
    {
        for_each_block_of(joints, level, team,
                          [&](const JointBlock& block) { eliminate_columns(joints, factor, block, lanes); });
        team.sync();
        for (std::int64_t t = joints.targets.first[level] + team.group(); t < joints.targets.first[level + 1];
             t += team.groups())
        {
            update_row(joints, factor, t, lanes);
        }
        team.sync();
    }
    for (std::int64_t level = joints.level_count - 1; level >= 0; --level)
    {
        for_each_block_of(joints, level, team, [&](const JointBlock& block) { substitute(factor, block, lanes); });
        team.sync();
    }
}

} // namespace tread::dem::joint_solve
