#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace tread::solver
{

/// Measurements of the last step for the choice of the next; contacts are those at its beginning.
struct Pace
{
    double largest_speed    = 0; ///< m/s, of points and bodies
    double sand_speed       = 0; ///< m/s, largest of a point
    double stiffest_point   = 0; ///< 1/s2, k/m_p of the stiffest live sand-body contact
    double shortest_contact = 0; ///< s, min over bodies of sqrt(m / sum of K); 0 = no body contact
    double overlap          = 0; ///< largest overlap of bodies over radius
};

/// Bounds that hold for the whole run.
struct PaceLimits
{
    double spacing       = 0; ///< m, of the grid; 0 without sand
    double wave_speed    = 0; ///< m/s, fastest compression wave of the sand; 0 without sand
    double courant       = 0; ///< c_p dt/h: 0.4 at 1 point a cell, 0.6 at 8 and more
    double smallest_body = 0; ///< m, smallest radius; 0 without bodies
    double gravity       = 0; ///< m/s2, and what prescribed forces add to it
    double longest       = 0; ///< s, longest step allowed
};

struct TimeStep
{
    double       dt       = 0; ///< s
    std::int64_t substeps = 1;
    std::string  limit; ///< name of the bound that sets the step
};

inline constexpr double point_contact_bound = 0.5; ///< bound on k dt^2 / m_p, docs/theory.md#time-step
inline constexpr double displacement_bound  = 0.3; ///< v dt over the spacing, or v dt/N over the smallest body

/// Chooses the step within the limits c_p dt/h <= courant, v dt <= 0.3 h, k dt^2/m_p <= 0.5 at the stiffest sand-body
/// contact, dt/N <= contact_share sqrt(m / sum K), v dt/N <= 0.3 of the smallest body; without sand it also has N <=
/// 10, or up to 40 where bodies lie. It grows by at most 5 % a step. Values fixed by the scene are used unchanged.
TimeStep choose_step(const scene::TimeOptions& options, const PaceLimits& limits, const Pace& pace, double last_dt);

/// N of a step of dt (s): as the contacts require, or as the scene sets it.
std::int64_t substeps_of(const scene::TimeOptions& options, double dt, const PaceLimits& limits, const Pace& pace);

/// Shortens the last steps before `remaining` (s) runs out slightly, so that none of them is tiny: the support
/// acceleration of points in contact is a change of velocity over dt.
double fitted(double dt, double remaining);

/// Describes how far a step exceeds its limits, for a warning; empty if it does not.
std::optional<std::string> over_limit(const TimeStep& step, const PaceLimits& limits, const Pace& pace);

} // namespace tread::solver
