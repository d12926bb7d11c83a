#pragma once

#include <functional>
#include <vector>

#include "io/accept.hpp"
#include "solver/bodies/body_state.hpp"
#include "world/world.hpp"

// Contact records of the pairs of bodies: friction, rolling resistance and place of each patch. They go from one run to
// another, and through checkpoints.
namespace tread::solver
{

class StateFile;

/// Bound on keys of pairs that are loaded.
using KeyBound = std::function<io::accept::Verdict(const std::vector<std::uint64_t>&)>;

/// Accepts keys of two bodies, or of a body and a wall.
KeyBound accepted_keys(const world::World& world);

/// Whether this rank evaluates the contact of a pair of rows. `is_large`: dem::BodySizes::is_large.
template<class Exec>
bool is_answered_here(const BodyState<Exec>& state, const std::vector<std::int32_t>& is_large, std::uint64_t key);

/// Turns keys of a scene's pairs, of the data set `name`, into those of this rank's rows. Collective.
template<class Exec>
void take_keys_here(const BodyState<Exec>& state, std::vector<std::uint64_t>& keys, const StateFile& file,
                    const char* name);

/// Stores the world's contacts as the previous list: pairs found again keep their records.
template<class Exec>
void restore_contacts(BodyState<Exec>& state);

/// Records of the pairs that touched in the last step, of all ranks, by ascending key. Collective.
template<class Exec>
std::vector<world::ContactRecord> live_contacts(const BodyState<Exec>& state);

/// Saves the records of the listed pairs, or loads them: as the previous list of one rank, or those of pairs whose
/// contact this rank evaluates.
template<class Exec>
void transfer_contacts(BodyState<Exec>& state, StateFile& file);

} // namespace tread::solver
