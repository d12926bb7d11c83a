#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "kernels/dem/joints/joint.hpp"

namespace tread::dem
{

/// Lists of items, one after another: list k is item[first[k]] to item[first[k + 1] - 1].
template<class T>
struct ListsOf
{
    std::vector<std::int32_t> first{0};
    std::vector<T>            item;
};

/// An entry of the system of all rows, on or below the diagonal.
struct SystemEntry
{
    std::int32_t row, column;
};

/// Where the system of all joints' rows has entries, and in which order they are eliminated: known once for a scene, as
/// two rows meet only if their joints share a body. A step eliminates rows that do not meet.
struct Elimination
{
    std::vector<std::int32_t> first_row; ///< [joints], rows are numbered in the order of their elimination
    std::int32_t              row_count = 0;

    ListsOf<std::int32_t> pivots;  ///< [steps], rows that are eliminated
    ListsOf<SystemEntry>  entries; ///< [steps], their columns of the factor; the right-hand side is row `row_count`
    ListsOf<std::int32_t> before;  ///< [row_count + 1], columns before the diagonal where the factor has entries
    ListsOf<std::int32_t> below;   ///< [row_count], rows below the diagonal where the factor has entries
};

/// Bodies that a joint ties: of a differential those of its two revolute joints.
std::set<std::size_t> bodies_of(const std::vector<Joint>& joints, std::size_t j);

/// Plans the elimination by least degree (W. F. Tinney and J. W. Walker 1967, Proc. IEEE 55:1801), many joints at once:
/// the wheels of a rover come before its rockers. `row_counts` are those of the joints.
Elimination plan_elimination(const std::vector<Joint>& joints, const std::vector<std::int32_t>& row_counts);

} // namespace tread::dem
