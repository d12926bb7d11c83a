#include "base/communicator.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <fmt/format.h>

namespace tread
{

void check_mpi(int result, const char* what)
{
    if (result == MPI_SUCCESS) { return; }
    char text[MPI_MAX_ERROR_STRING];
    int  length = 0;
    MPI_Error_string(result, text, &length);
    throw EnvironmentError(
        fmt::format("MPI: {} failed: {}", what, std::string(text, static_cast<std::size_t>(length))));
}

namespace
{

/// Splits `all` by machine and returns the part of this rank, which is `rank` in `all`. The caller frees it.
MPI_Comm ranks_of_machine(MPI_Comm all, int rank)
{
    MPI_Comm machine = MPI_COMM_NULL;
    check_mpi(MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &machine), "split by machine");
    return machine;
}

std::int64_t reduce(const Communicator& communicator, std::int64_t value, MPI_Op operation)
{
    std::int64_t  result = 0;
    const Waiting wait(communicator.waits(), "all-reduce");
    check_mpi(MPI_Allreduce(&value, &result, 1, MPI_INT64_T, operation, communicator.native()), "all-reduce");
    return result;
}

template<class T>
std::vector<T> gather_all(const Communicator& communicator, T value, MPI_Datatype type)
{
    if (communicator.size() == 1) { return std::vector<T>{value}; }
    std::vector<T> values(static_cast<std::size_t>(communicator.size()));
    const Waiting  wait(communicator.waits(), "all-gather");
    check_mpi(MPI_Allgather(&value, 1, type, values.data(), 1, type, communicator.native()), "all-gather");
    return values;
}

template<class T>
std::vector<T> gather_all(const Communicator& communicator, const std::vector<T>& values, MPI_Datatype type)
{
    if (communicator.size() == 1) { return values; }
    std::vector<int> counts, places;
    int              place = 0;
    for (const std::int64_t count : communicator.gather(static_cast<std::int64_t>(values.size())))
    {
        counts.push_back(static_cast<int>(count));
        places.push_back(place);
        place += static_cast<int>(count);
    }
    std::vector<T> all(static_cast<std::size_t>(place));
    const Waiting  wait(communicator.waits(), "all-gather");
    check_mpi(MPI_Allgatherv(values.data(), static_cast<int>(values.size()), type, all.data(), counts.data(),
                             places.data(), type, communicator.native()),
              "all-gather");
    return all;
}

/// Rethrows with the error type of the failing rank.
[[noreturn]] void rethrow(ExitCode code, const std::string& message)
{
    switch (code)
    {
    case ExitCode::bad_input:
        throw InputError(message);
    case ExitCode::numerical:
        throw NumericalError(message);
    case ExitCode::environment:
        throw EnvironmentError(message);
    default:
        throw Error(code, message);
    }
}

} // namespace

Communicator::Communicator(MPI_Comm original)
{
    check_mpi(MPI_Comm_dup(original, &native_), "duplicating a communicator");
    MPI_Comm_set_errhandler(native_, MPI_ERRORS_RETURN);
    check_mpi(MPI_Comm_dup(original, &meeting_), "duplicating a communicator");
    MPI_Comm_set_errhandler(meeting_, MPI_ERRORS_RETURN);
    MPI_Comm_rank(native_, &rank_);
    MPI_Comm_size(native_, &size_);
}

Communicator::~Communicator()
{
    MPI_Comm_free(&meeting_);
    MPI_Comm_free(&native_);
}

void Communicator::barrier() const
{
    if (size_ == 1) { return; }
    const Waiting wait(waits_, "barrier");
    check_mpi(MPI_Barrier(native_), "barrier");
}

bool Communicator::all_arrive(double seconds) const
{
    const Waiting wait(waits_, "the end of a run or of its steps");
    MPI_Request   request = MPI_REQUEST_NULL;
    check_mpi(MPI_Ibarrier(meeting_, &request), "barrier");
    const double start = MPI_Wtime();
    int          done  = 0;
    while (true)
    {
        check_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "barrier");
        if (done != 0) { return true; }
        if (MPI_Wtime() - start > seconds) { return false; }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void Communicator::abort(ExitCode code) const
{
    MPI_Abort(native_, static_cast<int>(code));
    std::_Exit(static_cast<int>(code));
}

int Communicator::local_rank() const
{
    MPI_Comm machine = ranks_of_machine(native_, rank_);
    int      rank    = 0;
    MPI_Comm_rank(machine, &rank);
    MPI_Comm_free(&machine);
    return rank;
}

int Communicator::local_size() const
{
    if (size_ == 1) { return 1; }
    MPI_Comm machine = ranks_of_machine(native_, rank_);
    int      size    = 1;
    MPI_Comm_size(machine, &size);
    MPI_Comm_free(&machine);
    return size;
}

std::string Communicator::broadcast(const std::string& text, int from) const
{
    if (size_ == 1) { return text; }
    const Waiting wait(waits_, "broadcast", {from});
    std::int64_t  length = static_cast<std::int64_t>(text.size());
    check_mpi(MPI_Bcast(&length, 1, MPI_INT64_T, from, native_), "broadcast");
    std::string result = text;
    result.resize(static_cast<std::size_t>(length));
    check_mpi(MPI_Bcast(result.data(), static_cast<int>(length), MPI_CHAR, from, native_), "broadcast");
    return result;
}

std::int64_t Communicator::sum(std::int64_t value) const { return size_ == 1 ? value : reduce(*this, value, MPI_SUM); }
std::int64_t Communicator::maximum(std::int64_t value) const
{
    return size_ == 1 ? value : reduce(*this, value, MPI_MAX);
}

std::vector<std::int64_t> Communicator::gather(std::int64_t value) const
{
    return gather_all(*this, value, MPI_INT64_T);
}

std::vector<double> Communicator::gather(double value) const { return gather_all(*this, value, MPI_DOUBLE); }

std::vector<std::string> Communicator::gather(const std::string& text) const
{
    const std::vector<std::int64_t> lengths = gather(static_cast<std::int64_t>(text.size()));
    const std::vector<char>         all     = gather_all(*this, std::vector<char>(text.begin(), text.end()), MPI_CHAR);
    std::vector<std::string>        texts;
    auto                            at = all.begin();
    for (const std::int64_t length : lengths)
    {
        texts.emplace_back(at, at + length);
        at += length;
    }
    return texts;
}

std::vector<std::int32_t> Communicator::gather(const std::vector<std::int32_t>& values) const
{
    return gather_all(*this, values, MPI_INT32_T);
}

std::vector<std::uint64_t> Communicator::gather(const std::vector<std::uint64_t>& values) const
{
    return gather_all(*this, values, MPI_UINT64_T);
}

std::vector<double> Communicator::gather(const std::vector<double>& values) const
{
    return gather_all(*this, values, MPI_DOUBLE);
}

std::vector<std::int64_t> Communicator::all_to_all(const std::vector<std::int64_t>& to) const
{
    std::vector<std::int64_t> from(to.size());
    const Waiting             wait(waits_, "all-to-all");
    check_mpi(MPI_Alltoall(to.data(), 1, MPI_INT64_T, from.data(), 1, MPI_INT64_T, native_), "all-to-all");
    return from;
}

std::vector<std::vector<std::uint64_t>>
Communicator::all_to_all(const std::vector<std::vector<std::uint64_t>>& to) const
{
    std::vector<std::int64_t> counts;
    counts.reserve(to.size());
    for (const auto& values : to) { counts.push_back(static_cast<std::int64_t>(values.size())); }
    const std::vector<std::int64_t> coming = all_to_all(counts);

    std::vector<std::uint64_t> out;
    std::vector<int>           out_count, out_place, in_count, in_place;
    int                        place = 0;
    for (const auto& values : to)
    {
        out_place.push_back(static_cast<int>(out.size()));
        out_count.push_back(static_cast<int>(values.size()));
        out.insert(out.end(), values.begin(), values.end());
    }
    for (const std::int64_t count : coming)
    {
        in_place.push_back(place);
        in_count.push_back(static_cast<int>(count));
        place += static_cast<int>(count);
    }
    std::vector<std::uint64_t> in(static_cast<std::size_t>(place));
    const Waiting              wait(waits_, "all-to-all");
    check_mpi(MPI_Alltoallv(out.data(), out_count.data(), out_place.data(), MPI_UINT64_T, in.data(), in_count.data(),
                            in_place.data(), MPI_UINT64_T, native_),
              "all-to-all");
    std::vector<std::vector<std::uint64_t>> from;
    for (std::size_t rank = 0; rank < coming.size(); ++rank)
    {
        from.emplace_back(in.begin() + in_place[rank], in.begin() + in_place[rank] + in_count[rank]);
    }
    return from;
}

MpiSession::Library::Library()
{
    int provided = MPI_THREAD_SINGLE;
    check_mpi(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "initialisation");
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    if (provided < MPI_THREAD_FUNNELED)
    {
        MPI_Finalize();
        throw EnvironmentError("MPI: this library allows no threads beside it (MPI_THREAD_FUNNELED is needed)");
    }
}

MpiSession::Library::~Library() { MPI_Finalize(); }

MpiSession::MpiSession()
    : world_(MPI_COMM_WORLD)
{
    require_launcher_agrees(world_.size());
}

std::string host_name()
{
    char name[MPI_MAX_PROCESSOR_NAME];
    int  length = 0;
    MPI_Get_processor_name(name, &length);
    return {name, static_cast<std::size_t>(length)};
}

void on_root(const Communicator& communicator, const std::function<void()>& work)
{
    std::int64_t code = 0;
    std::string  message;
    if (communicator.rank() == 0)
    {
        try
        {
            work();
        }
        catch (const Error& error)
        {
            code    = static_cast<std::int64_t>(error.code());
            message = error.what();
        }
    }
    code = communicator.maximum(code);
    if (code != 0) { rethrow(static_cast<ExitCode>(code), communicator.broadcast(message)); }
}

void on_every_rank(const Communicator& communicator, const std::function<void()>& work)
{
    std::int64_t own = 0;
    std::string  message;
    try
    {
        work();
    }
    catch (const Error& error)
    {
        own     = static_cast<std::int64_t>(error.code());
        message = error.what();
    }
    const std::vector<std::int64_t> codes = communicator.gather(own);
    const auto first = std::find_if(codes.begin(), codes.end(), [](std::int64_t code) { return code != 0; });
    if (first == codes.end()) { return; }
    const auto                     rank     = static_cast<int>(first - codes.begin());
    const std::vector<std::string> messages = communicator.gather(message);
    if (std::equal(messages.begin() + 1, messages.end(), messages.begin()))
    {
        rethrow(static_cast<ExitCode>(*first), message);
    }
    const std::string host = communicator.broadcast(host_name(), rank);
    rethrow(static_cast<ExitCode>(*first),
            fmt::format("rank {} on {}: {}", rank, host, messages[static_cast<std::size_t>(rank)]));
}

void require_launcher_agrees(int mpi_size)
{
    if (mpi_size > 1) { return; }
    for (const char* variable : {"SLURM_STEP_NUM_TASKS", "PMI_SIZE", "OMPI_COMM_WORLD_SIZE"})
    {
        const char* value = std::getenv(variable);
        if (value == nullptr || std::atoi(value) <= 1) { continue; }
        throw EnvironmentError(fmt::format(
            "MPI sees one rank, but the launcher started {0} tasks ({1}={0}): they do not know of each other. "
            "With SLURM use `srun --mpi=pmix` (`srun --mpi=list` shows what there is), or mpirun of the MPI that tread "
            "was built with",
            value, variable));
    }
}

} // namespace tread
