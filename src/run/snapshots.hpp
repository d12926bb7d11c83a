#pragma once

#include <future>
#include <vector>

#include "io/snapshot.hpp"
#include "solver/simulation.hpp"

namespace tread::run
{

/// The snapshots of a run. On one rank they are written behind the computation: what they show is copied to the host,
/// and a thread makes rows of it and writes them while steps go on. There is one copy: the next snapshot waits for the
/// one before. HDF5 is not made for several threads: while writing() no other file may be touched through it. On
/// several ranks snapshots are written where they are due: collective calls of a second thread beside the solver's
/// messages would take MPI_THREAD_MULTIPLE.
template<class Exec, class Real>
class Snapshots
{
public:
    Snapshots(const Communicator& communicator, const Exec& exec, io::SnapshotWriter files);

    /// The next snapshot, of the present state; `time` in s. EnvironmentError when this one or one before it could not
    /// be written. Collective.
    void write(double time, solver::Simulation<Exec, Real>& simulation);

    bool writing() const;

    /// All are written; EnvironmentError when that failed.
    void finish();

    /// Times (s) of all so far; and those to go on behind.
    const std::vector<double>& times();
    void                       resume(std::vector<double> times);

private:
    bool                          alone_;
    solver::PointCopy<Exec, Real> points_;
    io::BodyFields                bodies_;
    io::SnapshotWriter            files_;
    std::future<void>             under_way_; ///< last: its end is waited for before the rest goes
};

} // namespace tread::run
