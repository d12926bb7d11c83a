#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "world/world.hpp"

// How much sand and rock there is at each height, in columns over the plan, and how high it stands.
namespace tread::world
{

/// Columns over the plan of the domain, cut into bins. A column is as wide as a cell of the grid, with rocks at least
/// two of their mean diameters, so that it holds several of them. A bin is as high as a cell (thinner ones would hold
/// few points each, thicker ones blur where the bed ends), with rocks at least half a mean diameter.
struct ColumnLattice
{
    std::array<std::int64_t, 2> count{0, 0}; ///< columns along x and y; 0 without terrain
    std::array<double, 2>       width{1, 1}; ///< m
    double                      bin = 1;     ///< m

    std::int64_t size() const { return count[0] * count[1]; }
};

ColumnLattice column_lattice(const scene::Scene& scene, const World& world);

/// EnvironmentError where a map of a scene's columns does not fit into memory.
void require_room_for_columns(const scene::Scene& scene, const World& world);

/// The volume of sand and rock in each bin of a lattice.
class TerrainBins
{
public:
    explicit TerrainBins(const ColumnLattice& lattice);

    /// A cube of this volume (m3) about `centre` (m): each bin gets what lies in it. What lies beyond the outermost
    /// columns counts as theirs.
    void add_cube(const Vec3<double>& centre, double volume) { add_block(centre, std::cbrt(volume), volume); }

    /// A sphere, as 32 cubes.
    void add_sphere(const Vec3<double>& centre, double radius);

    /// Adds up all ranks' bins on every rank, in rank order. Collective.
    void add_ranks(const Communicator& communicator);

    /// Height of the terrain's surface in each column, x fastest, m; NaN where there is no terrain. From the top down,
    /// the first bin that is full enough is the top of the bed. What lies from some bins under it (as many as make the
    /// column's width, so that a slope ends within them) up to the bin above it would fill the column up to the
    /// surface, if it were packed as densely as the bins below. What floats still higher is taken to float with the
    /// same density down to the surface, and does not count. Exact for a level bed of points wherever their lattice
    /// stands.
    std::vector<double> surface() const;

private:
    struct Column
    {
        std::int64_t        first = 0; ///< number of the lowest bin
        std::vector<double> volume;    ///< m3
    };

    void   add_block(const Vec3<double>& centre, double edge, double volume);
    void   add_to_column(Column& column, double low, double high, double volume) const;
    double area() const { return lattice_.width[0] * lattice_.width[1]; }

    ColumnLattice       lattice_;
    std::vector<Column> columns_;
};

} // namespace tread::world
