#include "kernels/dem/joints/elimination.hpp"

#include <algorithm>
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

/// Joints in levels: those of a level do not meet, not even through joints of levels before.
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

template<class T>
void close_list(ListsOf<T>& lists)
{
    lists.first.push_back(static_cast<std::int32_t>(lists.item.size()));
}

/// Makes the lists of rows from those of joints.
struct Planner
{
    const Levels&                    levels;
    const std::vector<std::int32_t>& row_counts;
    Elimination                      plan;

    void number_rows()
    {
        plan.first_row.resize(row_counts.size());
        for (const auto& level : levels.joints)
        {
            for (const std::size_t j : level)
            {
                plan.first_row[j] = plan.row_count;
                plan.row_count += row_counts[j];
            }
        }
    }

    std::vector<std::int32_t> rows_below(std::size_t joint, std::int32_t row) const
    {
        std::vector<std::int32_t> rows;
        const auto                add = [&](std::int32_t first, std::int32_t end)
        {
            for (std::int32_t r = first; r < end; ++r) { rows.push_back(r); }
        };
        add(row + 1, plan.first_row[joint] + row_counts[joint]);
        for (const std::size_t other : levels.later[joint])
        {
            add(plan.first_row[other], plan.first_row[other] + row_counts[other]);
        }
        std::sort(rows.begin(), rows.end());
        return rows;
    }

    void add_step(const std::vector<std::size_t>& level, std::int32_t of_joint)
    {
        for (const std::size_t j : level)
        {
            if (of_joint >= row_counts[j]) { continue; }
            const std::int32_t row = plan.first_row[j] + of_joint;
            plan.pivots.item.push_back(row);
            plan.entries.item.push_back({row, row});
            for (const std::int32_t i : rows_below(j, row)) { plan.entries.item.push_back({i, row}); }
            plan.entries.item.push_back({plan.row_count, row});
        }
        close_list(plan.pivots);
        close_list(plan.entries);
    }

    void add_steps()
    {
        for (const auto& level : levels.joints)
        {
            std::int32_t most = 0;
            for (const std::size_t j : level) { most = std::max(most, row_counts[j]); }
            for (std::int32_t of_joint = 0; of_joint < most; ++of_joint) { add_step(level, of_joint); }
        }
    }

    void add_lists()
    {
        std::vector<std::vector<std::int32_t>> before(static_cast<std::size_t>(plan.row_count) + 1);
        for (const auto& level : levels.joints)
        {
            for (const std::size_t j : level)
            {
                for (std::int32_t row = plan.first_row[j]; row < plan.first_row[j] + row_counts[j]; ++row)
                {
                    for (const std::int32_t i : rows_below(j, row))
                    {
                        plan.below.item.push_back(i);
                        before[static_cast<std::size_t>(i)].push_back(row);
                    }
                    close_list(plan.below);
                    before.back().push_back(row);
                }
            }
        }
        for (const std::vector<std::int32_t>& columns : before)
        {
            plan.before.item.insert(plan.before.item.end(), columns.begin(), columns.end());
            close_list(plan.before);
        }
    }
};

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
    Planner      planner{levels, row_counts, {}};
    planner.number_rows();
    planner.add_steps();
    planner.add_lists();
    return planner.plan;
}

} // namespace tread::dem
