#pragma once

#include <vector>

#include "decomp/balance.hpp"
#include "io/run_directory.hpp"
#include "io/snapshot.hpp"
#include "io/time_series.hpp"
#include "solver/bodies/body_joints.hpp"
#include "solver/bodies/body_row.hpp"
#include "solver/ledger/ledger.hpp"
#include "world/world.hpp"

namespace tread::run
{

/// The tables of timeseries.h5.
std::vector<io::SeriesTable> series_tables(const scene::Scene& scene, int ranks);

/// timeseries.h5 of a run: /wheel/<name>, /energy, /balance, /phases, and on several ranks /ranks.
class Recorder
{
public:
    Recorder(const io::RunDirectory& directory, const scene::Scene& scene, const world::World& world, int ranks,
             const io::Provenance& provenance, io::SeriesFile file = io::SeriesFile::anew);

    /// Writes all buffered rows to the file.
    void flush() { series_.flush(); }

    void begin_phase(std::size_t index, double time);

    /// Writes a row of /ranks, in a run on several ranks.
    void write_ranks(double time, const decomp::BalanceRow& balance);

    void write(double time, const std::vector<solver::BodyRow>& bodies, const solver::EnergyRow& energy,
               const solver::BalanceRow& balance);

    void write_joints(double time, const std::vector<solver::JointRow>& joints);

private:
    const scene::Scene& scene_;
    std::vector<double> rolling_radii_;
    io::TimeSeries      series_;
};

} // namespace tread::run
