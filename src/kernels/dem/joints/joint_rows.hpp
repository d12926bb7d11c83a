#pragma once

#include <cstdint>

#include "kernels/dem/joints/elimination.hpp"

// Rows of the linear system of the joints (joint_rows_kern.hpp makes them, joint_solve_kern.hpp solves them).
namespace tread::dem
{

inline constexpr int most_row_sides = 4; ///< a differential has up to four bodies

/// Number of values of the lower triangle of a system of n rows, with its right-hand side as the last row.
TREAD_HD std::int64_t factor_size(std::int64_t n) { return (n + 1) * (n + 2) / 2; }

/// Whether a row takes part in the solve, or has its impulse held at a bound.
enum RowState : std::int32_t
{
    row_solved,
    row_at_low,
    row_at_high,
    row_states, ///< number of states
};

/// One row: sum over sides of linear . v + angular . omega = target - softness impulse, with impulse in [low, high].
struct JointRow
{
    std::int32_t sides;
    std::int32_t link[most_row_sides]; ///< index among the jointed bodies
    Vec3<double> linear[most_row_sides];
    Vec3<double> angular[most_row_sides];
    Vec3<double> linear_response[most_row_sides]; ///< change of the velocity by a unit impulse
    Vec3<double> angular_response[most_row_sides];

    double       target;
    double       softness;
    double       relative_softness; ///< of the row's own response to a unit impulse; added to softness
    double       low, high;         ///< N s or N m s
    double       diagonal;          ///< change of the row's rate by a unit impulse, and softness
    double       impulse;
    std::int32_t works;   ///< 1 = the row may do work: spring, motor, limit
    std::int32_t skipped; ///< 1 = depends on rows before it in this configuration, or nothing can move
};

/// A jointed body in a substep: its velocity without joints, and how it yields to impulses.
struct JointLink
{
    Vec3<double> velocity;         ///< m/s, after the substep
    Vec3<double> angular_velocity; ///< rad/s, at mid-step: that which turns the body
    Mat3<double> mobility;         ///< 1/kg, world frame; 0 in locked directions
    Mat3<double> response;         ///< 1/(kg m2), world frame; 0 in locked directions
    double       inverse_mass;     ///< 1/kg, of the body without locks
    double       inverse_inertia;  ///< 1/(kg m2), likewise: bound over all axes
};

/// View of IndexLists.
struct IndexListsView
{
    const std::int32_t* first = nullptr;
    const std::int32_t* item  = nullptr;
};

/// View of the joints of a scene and of the memory of their solve.
struct JointsView
{
    std::int64_t        joint_count = 0;
    std::int64_t        link_count  = 0; ///< bodies with joints
    std::int64_t        row_count   = 0;
    const Joint*        joint       = nullptr;
    const std::int32_t* body        = nullptr; ///< [link_count], ascending
    const std::int32_t* place       = nullptr; ///< [bodies], index in `body`, or -1
    JointLink*          link        = nullptr;
    JointLink*          moved       = nullptr; ///< the links with the impulses of the rows; velocities only
    JointRow*           row         = nullptr;
    std::int32_t*       state       = nullptr; ///< [row_count], RowState; kept from substep to substep
    double*             factor      = nullptr; ///< [factor_size(row_count)]
    JointWrench*        wrench      = nullptr; ///< [link_count]
    JointRecord*        record      = nullptr; ///< [joint_count]
    std::int32_t*       changed     = nullptr; ///< [1], whether a row changed its state
    std::int64_t        level_count = 0;
    IndexListsView      levels;       ///< [level_count], as in Elimination
    IndexListsView      below;        ///< [joint_count], likewise
    IndexListsView      targets;      ///< [level_count], likewise
    IndexListsView      changed_by;   ///< [targets], likewise
    IndexListsView      rows_of_link; ///< [link_count], rows of all joints of the body

    JointWrenches wrenches() const { return {place, wrench}; }
};

} // namespace tread::dem
