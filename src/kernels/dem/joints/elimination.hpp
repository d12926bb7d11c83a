#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "kernels/dem/joints/joint.hpp"

namespace tread::dem
{

/// Lists of items, one after another: list k is item[first[k]] to item[first[k + 1] - 1].
struct IndexLists
{
    std::vector<std::int32_t> first{0};
    std::vector<std::int32_t> item;

    /// Ends the present list.
    void close() { first.push_back(static_cast<std::int32_t>(item.size())); }
};

/// The order in which the rows of all joints are eliminated from their common system, known once for a scene: two rows
/// meet only if their joints share a body. Rows are numbered in that order, those of a joint one after another. A level
/// eliminates joints that do not meet, not even through joints of levels before.
struct Elimination
{
    std::vector<std::int32_t> first_row; ///< [joints]
    std::int32_t              row_count = 0;
    IndexLists                levels;  ///< [levels], joints
    IndexLists                below;   ///< [joints], rows of later joints that meet it when it is eliminated, ascending
    IndexLists                targets; ///< [levels], rows that the level's joints change: those below, and row_count
    IndexLists                changed_by; ///< [targets of all levels], joints of the level that change the row
};

/// Bodies that a joint ties: of a differential those of its two revolute joints.
std::set<std::size_t> bodies_of(const std::vector<Joint>& joints, std::size_t j);

/// Plans the elimination by least degree (W. F. Tinney and J. W. Walker 1967, Proc. IEEE 55:1801), many joints at once:
/// the wheels of a rover come before its rockers. `row_counts` are those of the joints.
Elimination plan_elimination(const std::vector<Joint>& joints, const std::vector<std::int32_t>& row_counts);

} // namespace tread::dem
