#pragma once

#include <future>
#include <vector>

#include "io/snapshot.hpp"
#include "solver/simulation.hpp"

namespace tread::run
{

/// Snapshots of a run. On one rank they are written asynchronously: fields are copied to the host, and a thread
/// converts and writes them while steps continue. There is one buffer: the next snapshot waits for the one before.
/// HDF5 is not thread-safe: while writing(), no other file may be accessed through it. On several ranks snapshots are
/// written synchronously: collective calls of a second thread beside the solver's messages would require
/// MPI_THREAD_MULTIPLE.
template<class Exec, class Real>
class Snapshots
{
public:
    Snapshots(const Communicator& communicator, const Exec& exec, io::SnapshotWriter files);

    /// Writes a snapshot of the present state; `time` in s. EnvironmentError when this one or one before it could not
    /// be written. Collective.
    void write(double time, solver::Simulation<Exec, Real>& simulation);

    bool writing() const;

    /// Waits until all are written; EnvironmentError if that failed.
    void finish();

    /// Returns the times (s) of all snapshots so far; resume() sets those of the run that this one continues.
    const std::vector<double>& times();
    void                       resume(std::vector<double> times);

private:
    bool                          alone_;
    solver::PointCopy<Exec, Real> points_;
    io::BodyFields                bodies_;
    io::SnapshotWriter            files_;
    std::future<void>             under_way_; ///< last: its destructor must wait before others run
};

} // namespace tread::run
