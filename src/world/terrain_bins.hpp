#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "world/world.hpp"

// Volume of sand and rock by height, in columns over the plan, and the surface height.
namespace tread::world
{

/// Columns over the plan of the domain, divided into bins. A column is as wide as a grid cell, and at least two mean
/// diameters of the rocks, so that it holds several of them. A bin is as high as a cell (thinner ones would hold few
/// points, thicker ones would blur the surface), and at least half a mean diameter of the rocks.
struct ColumnLattice
{
    std::array<std::int64_t, 2> count{0, 0}; ///< columns along x and y; 0 without terrain
    std::array<double, 2>       width{1, 1}; ///< m
    double                      bin = 1;     ///< m

    std::int64_t size() const { return count[0] * count[1]; }
};

ColumnLattice column_lattice(const scene::Scene& scene, const World& world);

/// Throws EnvironmentError where a map of a scene's columns does not fit into memory.
void require_room_for_columns(const scene::Scene& scene, const World& world);

/// The volume of sand and rock in each bin of a lattice.
class TerrainBins
{
public:
    explicit TerrainBins(const ColumnLattice& lattice);

    /// Adds a cube of this volume (m3) about `centre` (m) to the bins that it overlaps. Volume beyond the outermost
    /// columns counts as theirs.
    void add_cube(const Vec3<double>& centre, double volume) { add_block(centre, std::cbrt(volume), volume); }

    /// Adds a sphere, as 32 cubes.
    void add_sphere(const Vec3<double>& centre, double radius);

    /// Sums the bins of all ranks on every rank, in rank order. Collective.
    void add_ranks(const Communicator& communicator);

    /// Height of the terrain's surface in each column, x fastest, m; NaN where there is no terrain. The top of the bed
    /// is, from the top down, the first bin that is full enough. The volume from some bins below it (as many as make
    /// the column's width, so that a slope ends within them) up to the bin above it fills the column up to the surface
    /// at the packing density of the bins below. Volume that floats higher is assumed to have the same density down to
    /// the surface, and is not counted. Exact for a level bed of points at any position of their lattice.
    std::vector<double> surface() const;

private:
    struct Column
    {
        std::int64_t        first = 0; ///< index of the lowest bin
        std::vector<double> volume;    ///< m3
    };

    void   add_block(const Vec3<double>& centre, double edge, double volume);
    void   add_to_column(Column& column, double low, double high, double volume) const;
    double area() const { return lattice_.width[0] * lattice_.width[1]; }

    ColumnLattice       lattice_;
    std::vector<Column> columns_;
};

} // namespace tread::world
