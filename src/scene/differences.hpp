#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tread::scene
{

/// A key whose value differs between two scenes.
struct Difference
{
    std::string table;     ///< "output"; "phase" of an array of tables
    std::size_t index = 0; ///< in that array
    std::string key;
    std::string was; ///< TOML; empty = not given
    std::string is;
};

/// Lists the differences of two scenes as written by resolved_toml.
std::vector<Difference> differences(const std::string& before, const std::string& after);

/// Formats the key of a difference, as "[[phase]] 1 duration".
std::string place_of(const Difference& difference);

/// Formats a difference, as "[[phase]] 1 duration: 0.5, was 0.2".
std::string describe(const Difference& difference);

/// Index of the current phase of a run that has ended.
inline constexpr std::size_t no_phase_to_come = static_cast<std::size_t>(-1);

/// Whether a run in phase `phase` may continue with this change. Allowed: the title; intervals of output and
/// checkpoints, which change no result; the balance of ranks, which changes results by rounding alone; durations of the
/// present and later phases, which have not ended; and settings of sleep, if sand may sleep, so that the effect of
/// sleep can be measured. Any other change would alter steps already computed or define another problem.
bool may_change(const Difference& difference, std::size_t phase);

} // namespace tread::scene
