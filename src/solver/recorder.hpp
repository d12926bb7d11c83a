#pragma once

#include <vector>

#include "decomp/balance.hpp"
#include "io/run_directory.hpp"
#include "io/snapshot.hpp"
#include "io/time_series.hpp"
#include "solver/ledger.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

/// One named body at one time. Force and torque are those of all contacts, mean since the last row.
struct BodyRow
{
    Vec3<double> position;         ///< m
    Vec3<double> velocity;         ///< m/s
    Vec3<double> angular_velocity; ///< rad/s
    Vec3<double> force;            ///< N
    Vec3<double> torque;           ///< N m, about the centre of mass
    Vec3<double> axle;             ///< unit, world
    double       lowest;           ///< m, height of the lowest point
    double       surface = 0;      ///< m, height of the terrain under it before bodies came (SurfaceMap)
};

/// The tables of timeseries.h5.
std::vector<io::SeriesTable> series_tables(const scene::Scene& scene, int ranks);

/// timeseries.h5 of a run: /wheel/<name>, /energy, /balance, /phases, and on several ranks /ranks.
class Recorder
{
public:
    Recorder(const io::RunDirectory& directory, const scene::Scene& scene, const World& world, int ranks,
             const io::Provenance& provenance, io::SeriesFile file = io::SeriesFile::anew);

    /// All rows are in the file; until then they wait in memory.
    void flush() { series_.flush(); }

    void begin_phase(std::size_t index, double time);

    /// A row of /ranks, of a run on several ranks.
    void write_ranks(double time, const decomp::BalanceRow& balance);

    void write(double time, const std::vector<BodyRow>& bodies, const EnergyRow& energy, const BalanceRow& balance);

private:
    const scene::Scene& scene_;
    std::vector<double> rolling_radii_;
    io::TimeSeries      series_;
};

} // namespace tread::solver
