#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// A stage of a step, and whether the scene needs it.
struct Stage
{
    std::string name;
    bool        on;
    std::string why; ///< the reason why it is on or off
};

/// Parts of the state and of a step that a scene needs. Nothing else is constructed, allocated or launched.
struct Plan
{
    bool sand;         ///< points, pages, grid
    bool bodies;       ///< wheels or rocks
    bool coupling;     ///< sand-body contact
    bool body_contact; ///< body-body or body-wall contact; on several ranks for all bodies: pairs decide who holds them
    bool rays;         ///< contacts between bodies use rays
    bool plasticity;   ///< return mapping
    bool affine;       ///< affine transfers (APIC, AFLIP)
    bool damping;      ///< local damping in some phase
    bool rocks;
    bool snapshots;
    bool sleep;        ///< sleep of sand at rest
    bool rock_sleep;   ///< sleep of rocks at rest
    bool motions;      ///< a prescribed motion in some phase
    bool mass_scaling; ///< the inertia of rocks may be scaled up
    bool cap;          ///< points keep the pressure of a cap
    bool nonlocal;     ///< points keep a mean strain of their surroundings
};

/// Plans a run of a scene on `ranks` ranks.
Plan make_plan(const scene::Scene& scene, const world::World& world, int ranks = 1);

/// Lists the stages of a step on `ranks` ranks in order, as `tread check`, the log and summary.json show them.
std::vector<Stage> stages(const scene::Scene& scene, const Plan& plan, int ranks);

/// Stage names, shared by the plan, the clock and the tables.
namespace stage
{
inline constexpr const char* order        = "order points";
inline constexpr const char* sleep        = "sleep";
inline constexpr const char* pairs        = "find body pairs";
inline constexpr const char* candidates   = "find sand-body candidates";
inline constexpr const char* sand_contact = "sand-body contact";
inline constexpr const char* body_contact = "body-body contact";
inline constexpr const char* integrate    = "move bodies";
inline constexpr const char* scatter      = "points to grid";
inline constexpr const char* grid         = "grid";
inline constexpr const char* gather       = "grid to points";
inline constexpr const char* plasticity   = "return mapping";
inline constexpr const char* damping      = "local damping";
inline constexpr const char* measure      = "measure";
inline constexpr const char* output       = "output";
inline constexpr const char* snapshots    = "snapshots";
inline constexpr const char* checkpoints  = "checkpoints";
inline constexpr const char* halo         = "halo";
} // namespace stage

} // namespace tread::solver
