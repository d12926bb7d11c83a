#pragma once

#include <vector>

#include "solver/bodies/body_row.hpp"
#include "world/terrain_bins.hpp"

namespace tread::solver
{
class StateFile;
}

namespace tread::run
{

/// Projection onto the plan of the part of a named body that may press on terrain.
struct Footprint
{
    double length; ///< m, across the axle: a wheel's radius (its chord at a sinkage of an eighth of that)
    double width;  ///< m, along the axle: a wheel's width; else equal to the length
    double reach;  ///< m, bounding radius
};

/// Footprints of the named bodies.
std::vector<Footprint> footprints(const world::World& world);

/// Height of the terrain's surface over the plan before bodies pressed on it: the reference for sinkage. z is the axis
/// along which terrain is stacked, whatever the direction of gravity. The same on all ranks.
class SurfaceMap
{
public:
    SurfaceMap(const scene::Scene& scene, const world::World& world);

    const world::ColumnLattice& lattice() const { return lattice_; }

    /// Updates the heights (TerrainBins::surface) of columns on which no body has pressed.
    void renew(const std::vector<double>& heights);

    /// Freezes the height of columns within a body's reach and above its lowest point.
    void press(const std::vector<solver::BodyRow>& bodies);

    /// m, mean height over the footprint of named body `body`, interpolated between columns; where there is no terrain
    /// under it, the height of the nearest column with terrain; without any terrain 0, the floor of the domain.
    double under(std::size_t body, const solver::BodyRow& row) const;

    /// Saves to a checkpoint, or loads from it.
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
