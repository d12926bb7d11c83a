#pragma once

#include <vector>

#include "solver/body_row.hpp"
#include "world/terrain_bins.hpp"

namespace tread::solver
{
class StateFile;
}

namespace tread::run
{

/// The plan of a named body where it may press on terrain.
struct Footprint
{
    double length; ///< m, across the axle: a wheel's radius (its chord where it sinks in by an eighth of that)
    double width;  ///< m, along the axle: a wheel's width; else as long
    double reach;  ///< m, bounding radius
};

/// Of each named body.
std::vector<Footprint> footprints(const world::World& world);

/// Height of the terrain's surface over the plan, as it was before bodies came: what sinkage counts from. z is the axis
/// along which terrain is stacked, whatever way gravity points. The same on all ranks.
class SurfaceMap
{
public:
    SurfaceMap(const scene::Scene& scene, const world::World& world);

    const world::ColumnLattice& lattice() const { return lattice_; }

    /// Takes present heights (TerrainBins::surface) where no body has pressed so far.
    void renew(const std::vector<double>& heights);

    /// Columns within a body's reach and above its lowest point keep their height from now on.
    void press(const std::vector<solver::BodyRow>& bodies);

    /// m, mean over the footprint of named body `body`: the heights of columns, interpolated; where there is no terrain
    /// under it, of the nearest column that has some; without any 0, the floor of the domain.
    double under(std::size_t body, const solver::BodyRow& row) const;

    /// Into a checkpoint, or out of it.
    void transfer(solver::StateFile& file);

private:
    std::pair<std::int64_t, std::int64_t> columns_within(std::size_t axis, double place, double reach) const;

    double middle(std::size_t axis, std::int64_t column) const
    {
        return (static_cast<double>(column) + 0.5) * lattice_.width[axis];
    }
    double at(double x, double y) const;
    double nearest(double x, double y) const;

    world::ColumnLattice      lattice_;
    std::vector<Footprint>    footprints_;
    std::vector<double>       height_; ///< m, x fastest; NaN = no terrain
    std::vector<std::uint8_t> pressed_;
};

} // namespace tread::run
