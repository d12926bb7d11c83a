#pragma once

#include <vector>

#include "io/snapshot.hpp"
#include "kernels/dem/motion/totals.hpp"
#include "solver/bodies/body_row.hpp"
#include "solver/bodies/body_state.hpp"
#include "solver/bodies/named_means.hpp"
#include "solver/ledger/ledger.hpp"
#include "world/terrain_bins.hpp"

// Output of the bodies: stores for the ledger, rows for the recorder, fields for snapshots. Collective.
namespace tread::solver
{

/// Sums over all bodies at present; synchronises.
template<class Exec>
RigidCensus body_census(BodyState<Exec>& state, const dem::BodyTotals<Exec>& totals);

/// Rows of the named bodies; forces and torques are means since begin_mean().
template<class Exec>
std::vector<BodyRow> named_rows(BodyState<Exec>& state, const NamedMeans<Exec>& means);

/// Fields of this rank's block of the bodies (BodyBlocks).
template<class Exec>
io::BodyFields body_fields(const BodyState<Exec>& state);

/// Adds the rocks that this rank owns to the bins. Not collective.
template<class Exec>
void add_rocks(const BodyState<Exec>& state, world::TerrainBins& bins);

/// m, centre of a named body.
template<class Exec>
Vec3<double> body_place(const BodyState<Exec>& state, std::size_t body);

} // namespace tread::solver
