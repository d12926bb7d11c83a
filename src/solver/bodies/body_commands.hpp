#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "backend/vector.hpp"
#include "solver/bodies/body_command.hpp"
#include "solver/bodies/body_state.hpp"

namespace tread::solver
{

/// Work and impulse that commands have put into the bodies that this rank owns.
struct CommandTotals
{
    double       work    = 0;                    ///< J
    Vec3<double> impulse = Vec3<double>::Zero(); ///< N s
};

/// Commands of the named bodies (held, lowered, driven or free, and the share of their weight that acts), and what they
/// have brought about.
struct BodyCommands
{
    explicit BodyCommands(std::int64_t named)
        : present(static_cast<std::size_t>(named))
        , released(static_cast<std::size_t>(named), false)
    {
    }

    /// Returns and resets the totals.
    CommandTotals take_totals() { return std::exchange(totals, {}); }

    /// Saves or loads the commands and their impulse; their work and largest speed are in bodies/steps.
    void transfer(StateFile& file);

    std::vector<std::optional<BodyCommand>> present;           ///< last command of each named body
    std::vector<bool>                       released;          ///< named bodies that have been free before
    double                                  heaviest      = 1; ///< largest share of a body's weight that acts
    double                                  largest_speed = 0; ///< m/s, set by commands since it was last taken
    CommandTotals                           totals;            ///< since the last report
};

/// Sets what the named bodies are held or driven to; returns whether that changes the motion of any. A body that is
/// freed for the first time starts with the scene's velocity, one that was lowered starts at rest.
template<class Exec>
bool apply_commands(BodyState<Exec>& state, BodyCommands& commands, const std::vector<BodyCommand>& wanted);

} // namespace tread::solver
