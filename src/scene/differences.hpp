#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tread::scene
{

/// A key that two scenes do not agree on.
struct Difference
{
    std::string table;     ///< "output"; "phase" of an array of tables
    std::size_t index = 0; ///< in that array
    std::string key;
    std::string was; ///< TOML; empty = not given
    std::string is;
};

/// Of two scenes as resolved_toml writes them.
std::vector<Difference> differences(const std::string& before, const std::string& after);

/// "[[phase]] 1 duration".
std::string place_of(const Difference& difference);

/// "[[phase]] 1 duration: 0.5, was 0.2".
std::string describe(const Difference& difference);

/// The phase of a run that has ended.
inline constexpr std::size_t no_phase_to_come = static_cast<std::size_t>(-1);

/// Whether a run that is in phase `phase` may go on although this has changed:
/// the title; how often output and checkpoints are written, which changes no result; how sand falls to ranks, which
/// changes results by rounding alone; how long the present phase and those after it last, which have not ended; of sand
/// that may sleep, when it does, which is how the effect of sleep is measured. What has begun is not done again, and
/// what else changes makes another problem of it.
bool may_change(const Difference& difference, std::size_t phase);

} // namespace tread::scene
