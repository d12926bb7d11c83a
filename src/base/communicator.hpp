#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <mpi.h>

#include "base/errors.hpp"
#include "base/wait_note.hpp"

namespace tread
{

/// EnvironmentError with MPI's text if `result`, of the call named by `what`, is not success.
void check_mpi(int result, const char* what);

/// A group of MPI ranks with its own message space (a duplicate, so that messages never match those of another
/// library). Every call below is collective: all ranks make it, in the same order. A failing MPI call is an
/// EnvironmentError. A single rank answers without MPI, in any thread (except all_arrive and the calls after it).
class Communicator
{
public:
    explicit Communicator(MPI_Comm original);
    ~Communicator();
    Communicator(const Communicator&)            = delete;
    Communicator& operator=(const Communicator&) = delete;

    int      rank() const { return rank_; }
    int      size() const { return size_; }
    MPI_Comm native() const { return native_; }

    /// Record of what this rank waits for in calls of this class; callers that wait through native() record it here,
    /// too.
    WaitNote& waits() const { return waits_; }

    void barrier() const;

    /// Returns the text of rank `from` on every rank.
    std::string broadcast(const std::string& text, int from = 0) const;

    std::int64_t sum(std::int64_t value) const;
    std::int64_t maximum(std::int64_t value) const;

    /// Gathers one value of every rank, in rank order. Floating-point sums are added up from it in that order, and so
    /// do not depend on how MPI reduces.
    std::vector<std::int64_t> gather(std::int64_t value) const;
    std::vector<double>       gather(double value) const;
    std::vector<std::string>  gather(const std::string& text) const;

    /// Gathers the values of all ranks, concatenated in rank order.
    std::vector<std::int32_t>  gather(const std::vector<std::int32_t>& values) const;
    std::vector<std::uint64_t> gather(const std::vector<std::uint64_t>& values) const;
    std::vector<double>        gather(const std::vector<double>& values) const;

    /// Whether all other ranks call this within `seconds`; infinity waits for them. A failed rank may call it whatever
    /// messages and collective calls the others are in.
    bool all_arrive(double seconds) const;

    /// Ends the processes of all ranks; `code` becomes the exit code of the job.
    [[noreturn]] void abort(ExitCode code) const;

    /// Number of this rank among those on its machine.
    int local_rank() const;

    /// Number of ranks on this machine.
    int local_size() const;

    /// Sends to[r] to rank r; returns the value of every rank for this one.
    std::vector<std::int64_t>               all_to_all(const std::vector<std::int64_t>& to) const;
    std::vector<std::vector<std::uint64_t>> all_to_all(const std::vector<std::vector<std::uint64_t>>& to) const;

private:
    MPI_Comm native_  = MPI_COMM_NULL;
    MPI_Comm meeting_ = MPI_COMM_NULL; ///< used by all_arrive
    int      rank_    = 0;
    int      size_    = 1;

    mutable WaitNote waits_; ///< mutable: not part of the group's state
};

/// Initialises MPI, and finalises it when destroyed. EnvironmentError if MPI does not start, if it does not support
/// OpenMP threads (MPI_THREAD_FUNNELED), or if the launcher started tasks that MPI does not know of.
class MpiSession
{
public:
    MpiSession();

    const Communicator& world() const { return world_; }

private:
    struct Library
    {
        Library();
        ~Library();
    };

    Library      library_;
    Communicator world_;
};

/// Name of the machine according to MPI.
std::string host_name();

/// Runs `work` on every rank. If some throw an Error, all throw that of the lowest of them; its rank and host are
/// prepended to the message, unless all ranks failed alike.
void on_every_rank(const Communicator& communicator, const std::function<void()>& work);

/// Runs `work` on rank 0 alone. An error that it throws is thrown on every rank, so that all leave together.
void on_root(const Communicator& communicator, const std::function<void()>& work);

/// EnvironmentError if the environment says that this process is one of several tasks while MPI sees one rank: every
/// task would then run the whole scene. Reads SLURM_STEP_NUM_TASKS (set by srun for its own step, unlike SLURM_NTASKS,
/// which a batch script sees too), PMI_SIZE and OMPI_COMM_WORLD_SIZE.
void require_launcher_agrees(int mpi_size);

} // namespace tread
