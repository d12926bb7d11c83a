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

/// EnvironmentError with MPI's text if `result`, of the call that `what` names, is not success.
void check_mpi(int result, const char* what);

/// A group of MPI ranks with its own message space (a duplicate: no message of ours meets another library's).
/// Every call below is collective: all ranks make it, in the same order. A failing MPI call is an EnvironmentError. A
/// rank that is alone has the answer without MPI, in any thread (all_arrive and what follows it apart).
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

    /// What this rank waits for in calls of this class; those who wait by native() note it, too.
    WaitNote& waits() const { return waits_; }

    void barrier() const;

    /// The text of one rank, on every rank.
    std::string broadcast(const std::string& text, int from = 0) const;

    std::int64_t sum(std::int64_t value) const;
    std::int64_t maximum(std::int64_t value) const;

    /// One value of every rank, in rank order. Floating-point sums are made from it, in that order, and so do not
    /// depend on how MPI reduces.
    std::vector<std::int64_t> gather(std::int64_t value) const;
    std::vector<double>       gather(double value) const;
    std::vector<std::string>  gather(const std::string& text) const;

    /// The values of every rank, one rank's after the other's.
    std::vector<std::int32_t>  gather(const std::vector<std::int32_t>& values) const;
    std::vector<std::uint64_t> gather(const std::vector<std::uint64_t>& values) const;
    std::vector<double>        gather(const std::vector<double>& values) const;

    /// Whether all other ranks call this within so many seconds; infinity waits for them. Whatever messages and
    /// collective calls they are in meanwhile, a rank that has failed may call it.
    bool all_arrive(double seconds) const;

    /// Ends the processes of all ranks; `code` becomes the exit code of the job.
    [[noreturn]] void abort(ExitCode code) const;

    /// This rank's number among those on its machine.
    int local_rank() const;

    /// How many ranks are on its machine.
    int local_size() const;

    /// to[r] goes to rank r; of every rank what it had for this one.
    std::vector<std::int64_t>               all_to_all(const std::vector<std::int64_t>& to) const;
    std::vector<std::vector<std::uint64_t>> all_to_all(const std::vector<std::vector<std::uint64_t>>& to) const;

private:
    MPI_Comm native_  = MPI_COMM_NULL;
    MPI_Comm meeting_ = MPI_COMM_NULL; ///< of all_arrive
    int      rank_    = 0;
    int      size_    = 1;

    mutable WaitNote waits_; ///< says nothing of what the ranks are
};

/// MPI between construction and destruction. EnvironmentError when MPI does not start, when it has no place for
/// OpenMP threads (MPI_THREAD_FUNNELED), or when the launcher started tasks that MPI knows nothing of.
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

/// Name of the machine, as MPI has it.
std::string host_name();

/// Runs `work` on every rank. Where some throw an Error, all throw that of the lowest of them; unless all ranks failed
/// alike, its rank and host stand before the message.
void on_every_rank(const Communicator& communicator, const std::function<void()>& work);

/// Runs `work` on rank 0 alone. The error that it throws, if any, is thrown on every rank, so that all leave together.
void on_root(const Communicator& communicator, const std::function<void()>& work);

/// EnvironmentError if the environment of this process says that it is one of several tasks while MPI sees one
/// rank: every task would then run the whole scene. Reads SLURM_STEP_NUM_TASKS (set by srun for its own step, unlike
/// SLURM_NTASKS, which a batch script sees too), PMI_SIZE and OMPI_COMM_WORLD_SIZE.
void require_launcher_agrees(int mpi_size);

} // namespace tread
