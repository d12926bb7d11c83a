#include "kernels/dem/joints/elimination.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace tread::dem
{
namespace
{

using JointSet = std::set<std::size_t>;

/// For each joint the others that share a body with it.
std::vector<JointSet> neighbours_of(const std::vector<Joint>& joints)
{
    std::vector<JointSet> bodies, neighbours(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) { bodies.push_back(bodies_of(joints, j)); }
    const auto share = [&](std::size_t i, std::size_t j)
    { return std::any_of(bodies[i].begin(), bodies[i].end(), [&](std::size_t b) { return bodies[j].count(b) > 0; }); };
    for (std::size_t i = 0; i < joints.size(); ++i)
    {
        for (std::size_t j = 0; j < i; ++j)
        {
            if (!share(i, j)) { continue; }
            neighbours[i].insert(j);
            neighbours[j].insert(i);
        }
    }
    return neighbours;
}

/// Joints in levels, as in Elimination.
struct Levels
{
    std::vector<std::vector<std::size_t>> joints;
    std::vector<JointSet>                 later; ///< of each joint: those of later levels that it meets
};

/// Joints that do not meet, of at most two neighbours more than the one with the least.
std::vector<std::size_t> next_level(const JointSet& left, const std::vector<JointSet>& neighbours)
{
    std::vector<std::size_t> by_degree(left.begin(), left.end());
    std::stable_sort(by_degree.begin(), by_degree.end(),
                     [&](std::size_t a, std::size_t b) { return neighbours[a].size() < neighbours[b].size(); });
    const std::size_t        most = neighbours[by_degree.front()].size() + 2;
    std::vector<std::size_t> level;
    JointSet                 met;
    for (const std::size_t j : by_degree)
    {
        if (neighbours[j].size() > most || met.count(j) > 0) { continue; }
        level.push_back(j);
        met.insert(neighbours[j].begin(), neighbours[j].end());
    }
    return level;
}

Levels levels_of(const std::vector<Joint>& joints)
{
    Levels   levels{{}, neighbours_of(joints)};
    JointSet left;
    for (std::size_t j = 0; j < joints.size(); ++j) { left.insert(j); }
    while (!left.empty())
    {
        levels.joints.push_back(next_level(left, levels.later));
        for (const std::size_t j : levels.joints.back())
        {
            left.erase(j);
            for (const std::size_t a : levels.later[j])
            {
                levels.later[a].insert(levels.later[j].begin(), levels.later[j].end());
                levels.later[a].erase(a);
                levels.later[a].erase(j);
            }
        }
    }
    return levels;
}

std::vector<std::int32_t> rows_of(const JointSet& joints, const Elimination& plan,
                                  const std::vector<std::int32_t>& row_counts)
{
    std::vector<std::int32_t> rows;
    for (const std::size_t j : joints)
    {
        for (std::int32_t r = 0; r < row_counts[j]; ++r) { rows.push_back(plan.first_row[j] + r); }
    }
    std::sort(rows.begin(), rows.end());
    return rows;
}

/// Adds the targets of a level to the plan. The right-hand side, which all its joints change, comes first: it is the
/// longest.
void add_targets(const std::vector<std::size_t>& level, const Levels& levels,
                 const std::vector<std::int32_t>& row_counts, Elimination& plan)
{
    std::map<std::int32_t, std::vector<std::int32_t>, std::greater<>> changed_by;
    for (const std::size_t j : level)
    {
        const auto joint = static_cast<std::int32_t>(j);
        for (const std::int32_t row : rows_of(levels.later[j], plan, row_counts)) { changed_by[row].push_back(joint); }
        changed_by[plan.row_count].push_back(joint);
    }
    for (const auto& [row, joints] : changed_by)
    {
        plan.targets.item.push_back(row);
        plan.changed_by.item.insert(plan.changed_by.item.end(), joints.begin(), joints.end());
        plan.changed_by.close();
    }
    plan.targets.close();
}

} // namespace

std::set<std::size_t> bodies_of(const std::vector<Joint>& joints, std::size_t j)
{
    std::set<std::size_t> bodies;
    if (joints[j].kind == joint_differential)
    {
        for (const std::int32_t coupled : joints[j].couples)
        {
            bodies.merge(bodies_of(joints, static_cast<std::size_t>(coupled)));
        }
        return bodies;
    }
    for (const std::int32_t b : joints[j].body)
    {
        if (b != joint_world) { bodies.insert(static_cast<std::size_t>(b)); }
    }
    return bodies;
}

Elimination plan_elimination(const std::vector<Joint>& joints, const std::vector<std::int32_t>& row_counts)
{
    const Levels levels = levels_of(joints);
    Elimination  plan;
    plan.first_row.resize(joints.size());
    for (const std::vector<std::size_t>& level : levels.joints)
    {
        for (const std::size_t j : level)
        {
            plan.levels.item.push_back(static_cast<std::int32_t>(j));
            plan.first_row[j] = plan.row_count;
            plan.row_count += row_counts[j];
        }
        plan.levels.close();
    }
    for (const JointSet& later : levels.later)
    {
        const std::vector<std::int32_t> rows = rows_of(later, plan, row_counts);
        plan.below.item.insert(plan.below.item.end(), rows.begin(), rows.end());
        plan.below.close();
    }
    for (const std::vector<std::size_t>& level : levels.joints) { add_targets(level, levels, row_counts, plan); }
    return plan;
}

} // namespace tread::dem
