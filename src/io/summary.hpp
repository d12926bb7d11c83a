#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/exit_code.hpp"
#include "io/grid_error.hpp"
#include "io/resolution.hpp"

namespace tread::io
{

enum class RunStatus
{
    finished,
    stopped,
    failed
};

/// One stage of the plan: its calls and time, or why the scene does not need it.
struct StageReport
{
    std::string  name;
    bool         on = true;
    std::string  why; ///< why it is on or left out
    std::int64_t calls   = 0;
    double       seconds = 0;
};

/// Errors of a run, from its ledgers.
struct ErrorReport
{
    double mass     = 0; ///< relative
    double momentum = 0; ///< impulse imbalance over total weight x time
    double energy   = 0; ///< unaccounted energy over the largest energy exchanged
    double transfer = 0; ///< lost between points and grid, over the same
    double coupling = 0; ///< residual of the contacts between sand and bodies, over the same

    double mass_scaling = 0; ///< taken by the scaled inertia of rocks, over the same
};

/// A completed phase.
struct PhaseReport
{
    std::string           name;
    double                start = 0; ///< s
    double                time  = 0; ///< s, duration
    std::string           end;       ///< condition that ended it: "duration", "settled", "not settled", "lowered" ...
    std::optional<bool>   settled;   ///< whether it ended in equilibrium; null if that was not required
    double                unbalanced = 0;   ///< unbalanced force over the weight, at its end
    std::optional<double> packing_fraction; ///< of the bed of rocks that it settled; null without one
};

/// Sand of a [[terrain]] table at the start, after later tables and rocks replaced part of it.
struct TerrainReport
{
    std::string  material;
    std::int64_t points = 0;
    double       volume = 0; ///< m3
    double       mass   = 0; ///< kg
};

/// Rocks placed by a [[rocks]] table.
struct RocksReport
{
    std::string  shape;
    std::int64_t count             = 0;
    double       volume            = 0; ///< m3, of the rocks
    double       mass              = 0; ///< kg
    double       solid_fraction    = 0; ///< of their region between floor and height
    double       smallest_diameter = 0; ///< m
    double       mean_diameter     = 0;
    double       largest_diameter  = 0;
};

/// Volume shares in the region of a [[rocks]] table between floor and height, where there was sand before.
struct LayerReport
{
    std::int64_t table = 0; ///< index of the [[rocks]] table
    double       sand  = 0;
    double       rock  = 0; ///< of all tables
    double       empty = 0; ///< the remainder: `void` in summary.json
};

/// The bed at the start.
struct BedReport
{
    std::vector<TerrainReport> terrain;
    std::vector<RocksReport>   rocks;
    std::vector<LayerReport>   layers;         ///< where rocks replaced sand
    double                     rock_share = 0; ///< volume of rocks over that of rocks and points
};

/// Cost of writing checkpoints.
struct CheckpointReport
{
    std::string  newest; ///< path within the run's directory; empty = none
    std::int64_t written = 0;
    std::int64_t bytes   = 0; ///< of all of them
    double       seconds = 0;
};

/// A quantity of a body over the rows of a phase.
struct Answer
{
    std::string           name;
    std::string           unit;
    double                mean;
    double                spread;          ///< standard deviation of the rows
    double                standard_error;  ///< of the mean, from the means of eight parts; NaN with fewer than 8 rows
    std::optional<double> estimated_error; ///< numerical error; null: unknown
};

/// Answers of a named body in a phase, over its steady part.
struct PhaseAnswers
{
    std::string         phase;
    double              from   = 0; ///< s
    double              to     = 0; ///< s, time of the last row
    std::int64_t        rows   = 0;
    bool                steady = false; ///< if not, means are over the last half
    bool                ended  = true;  ///< false if the run stopped within the phase
    std::vector<Answer> quantities;
};

struct BodyAnswers
{
    std::string               body;
    std::vector<PhaseAnswers> phases;
};

/// How a run ended.
struct Outcome
{
    RunStatus   status    = RunStatus::finished;
    ExitCode    exit_code = ExitCode::finished;
    std::string reason; ///< why it ended
};

/// What was run, where and when.
struct RunIdentity
{
    std::string              scene_hash;
    std::string              backend;
    std::vector<std::string> devices;
    int                      ranks   = 1;
    int                      threads = 1;
    std::int64_t             points  = 0;
    std::int64_t             bodies  = 0;
    std::string              start; ///< UTC, of the first of the runs that this one continues
};

/// What a run computed and what that cost, including the runs that it continues.
struct CostReport
{
    std::int64_t             steps             = 0;
    std::int64_t             substeps          = 0; ///< total number
    double                   time              = 0; ///< s simulated
    double                   wall_s            = 0;
    std::int64_t             peak_device_bytes = 0;
    std::int64_t             peak_host_bytes   = 0;
    std::vector<StageReport> stages;
    std::optional<double>    asleep;       ///< mean share of sleeping points; null if sleep is off
    std::optional<double>    rocks_asleep; ///< mean share of sleeping rocks; null if none may sleep
    CheckpointReport         checkpoints;
    std::int64_t             restarts = 0; ///< number of times it was stopped and resumed
};

/// How well a run was resolved.
struct ResolutionReport
{
    double                   points_across = 0; ///< the contact patch of a named body on sand; 0 = none
    std::vector<Figure>      figures;
    std::optional<GridError> grid_error; ///< of a driven wheel's answers; null without one on granular sand
};

/// Summary of a run. docs/output.md lists the keys of summary.json; each has the name of its field here.
struct Summary
{
    Outcome                  outcome;
    RunIdentity              run;
    CostReport               cost;
    ErrorReport              errors;
    ResolutionReport         resolution;
    std::vector<std::string> warnings; ///< suspicious settings of the scene, a sentence each
    std::vector<PhaseReport> phases;
    BedReport                bed;
    std::vector<BodyAnswers> answers;
};

/// Verdict on a run, for its log and its summary. A failed run is under-resolved whatever its figures, because they
/// describe the part before the failure.
Verdict verdict_of(const Summary& summary);

/// Log line: the verdict and its reason: the failure, and each figure that is not resolved.
std::string verdict_line(const Summary& summary);

/// Text of summary.json. steps_per_s and sim_per_wall follow from the fields; numbers that are not finite are null.
std::string to_json(const Summary& summary);

/// Writes summary.json atomically; EnvironmentError if it cannot be written.
void write_summary(const std::string& path, const Summary& summary);

} // namespace tread::io
