#pragma once

#include <limits>
#include <string>

#include "run/phases.hpp"

namespace tread::solver
{
class StateFile;
}

namespace tread::run
{

enum class EndKind
{
    running,
    duration,  ///< ran for its whole duration
    settled,   ///< in equilibrium
    unsettled, ///< did not reach equilibrium within its max_duration
    lowered,   ///< the ground carries the lowered body
    unlowered, ///< it does not within the phase's max_duration
    end_of_bed ///< the driven body reached the end of the bed
};

/// Name in summary.json: "duration", "not settled".
const char* name_of(EndKind kind);

/// Kind of this name; EndKind::running if there is none.
EndKind end_kind(const std::string& name);

/// Whether the phase missed its goal, or was cut short.
bool deserves_warning(EndKind kind);

/// How a phase ended.
struct PhaseEnd
{
    EndKind kind  = EndKind::running;
    double  after = 0; ///< s since the phase began; if settled, includes the time for which equilibrium had to hold
    double  unbalanced = 0; ///< unbalanced force over the weight, at the end

    std::string body    = {}; ///< body that was lowered
    double      carried = 0;  ///< share of its weight that contacts carry at the end
    std::string place   = {}; ///< end that a drive reached
};

/// Describes the end for the log: "settled after ..."
std::string describe(const PhaseEnd& end);

/// Share of a body's weight that contacts carry: an exponential mean, in which a value d ago has weight exp(-d /
/// span).
struct CarriedShare
{
    /// Adds the integral (s) of that share over time until `time`, counted from any start.
    void note(double time, double integral);

    /// Contacts are intermittent: sand points touch one after the other, and each touch sends waves through the bed,
    /// of some 10 ms to its floor and back. A mean over that time follows the load during sinking into sand to some
    /// percent. Hard ground takes the whole load within less; the energy stored in the contact when the mean reaches
    /// the weight then throws the body up by at most speed times span: 0.5 mm at 0.05 m/s.
    static constexpr double span = 0.01; ///< s

    double last    = -1; ///< s, time of the last note(); negative = never
    double carried = 0;  ///< s, integral at that time
    double share   = 0;
};

inline constexpr double equilibrium_ratio = 1e-2; ///< unbalanced force over weight, below which a bed is at rest
inline constexpr double equilibrium_hold  = 0.05; ///< s for which it must stay below

/// Measurements that decide on the end of the running phase.
struct PhaseEndWatch
{
    double       still_since = std::numeric_limits<double>::infinity(); ///< s, since when the bed is in equilibrium
    CarriedShare carried     = {};                                      ///< by the ground, of the lowered body
    PhaseEnd     ending      = {};                                      ///< result of the last is_over()
};

/// Whether the phase is over at `time` (s); `unbalanced` = unbalanced force over the weight. Equilibrium requires it
/// at most equilibrium_ratio for equilibrium_hold of the phase's time without a break; lowering, that the carried
/// share reaches the scene's. Sets watch.ending.
bool is_over(const scene::Scene& scene, const RunningPhase& phase, PhaseEndWatch& watch, double time,
             double unbalanced);

/// Saves to a checkpoint, or loads from it.
void transfer(solver::StateFile& file, const scene::Scene& scene, RunningPhase& phase, PhaseEndWatch& watch);

} // namespace tread::run
