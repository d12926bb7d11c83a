#include "decomp/transport.hpp"
#include "backend/backends.hpp"
#include "backend/instantiate.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#if __has_include(<mpi-ext.h>)
#include <mpi-ext.h>
#endif

namespace tread::decomp
{
namespace
{

// MPI guarantees tags up to 32767. Turns of a channel get different tags, so that a rank that is one step ahead is
// detected.
constexpr int turns         = 64;
constexpr int most_channels = 32768 / turns;

// MPI counts in int.
constexpr std::int64_t most_bytes_a_message = std::int64_t{1} << 30;

struct Choice
{
    Carrier               carrier;
    std::unique_ptr<Nccl> nccl;
    std::string           description;
};

/// Whether the MPI library of every rank reports GPU support.
bool mpi_supports_gpus(const Communicator& communicator)
{
#if defined(OMPI_HAVE_MPI_EXT_CUDA) && OMPI_HAVE_MPI_EXT_CUDA
    const bool supports = MPIX_Query_cuda_support() == 1;
#else
    const bool supports = false;
#endif
    return communicator.maximum(supports ? 0 : 1) == 0;
}

Choice choose_for_gpus(const Communicator& communicator, TransportChoice choice)
{
    const bool any = choice == TransportChoice::automatic;
    if (choice == TransportChoice::host) { return {Carrier::host, nullptr, "MPI through pinned host memory"}; }
    if (choice != TransportChoice::nccl && mpi_supports_gpus(communicator))
    {
        return {Carrier::mpi, nullptr, "MPI from GPU memory"};
    }
    if (choice == TransportChoice::mpi)
    {
        throw EnvironmentError("--transport mpi: this MPI cannot send from GPU memory (MPIX_Query_cuda_support)");
    }
    try
    {
        auto nccl = std::make_unique<Nccl>(communicator);
        return {Carrier::nccl, std::move(nccl), "NCCL"};
    }
    catch (const EnvironmentError& error)
    {
        if (!any) { throw; }
        return {Carrier::host, nullptr,
                fmt::format("MPI through pinned host memory (this MPI cannot send from GPU memory; {})", error.what())};
    }
}

/// Calls f(first byte, bytes) for pieces that MPI can count; they arrive in the order of sending.
template<class F>
void for_each_piece(const MessageRange& range, F f)
{
    for (std::int64_t done = 0; done < range.bytes; done += most_bytes_a_message)
    {
        f(range.first + done, static_cast<int>(std::min(most_bytes_a_message, range.bytes - done)));
    }
}

} // namespace

template<class Exec>
Transport<Exec>::Transport(const Communicator& communicator, const Exec& exec, TransportChoice choice)
    : communicator_(communicator)
    , exec_(exec)
{
    Choice chosen = is_gpu<Exec> ? choose_for_gpus(communicator, choice) : Choice{Carrier::mpi, nullptr, "MPI"};
    nccl_         = std::move(chosen.nccl);
    carrier_      = chosen.carrier;
    description_  = std::move(chosen.description);
}

template<class Exec>
void Transport<Exec>::largest(std::int32_t* number)
{
    if constexpr (is_gpu<Exec>)
    {
        if (carrier_ == Carrier::nccl)
        {
            nccl_->largest(exec_, number);
            return;
        }
    }
    const auto all = static_cast<std::int32_t>(communicator_.maximum(read(exec_, number)));
    copy_from_host(exec_, number, &all, sizeof(all));
}

template<class Exec>
int Transport<Exec>::open_channel()
{
    if (channels_ == most_channels) { throw EnvironmentError("transport: too many kinds of messages"); }
    return channels_++;
}

template<class Exec>
Messages<Exec>::Messages(Transport<Exec>& transport, const Exec& exec, const char* name)
    : transport_(&transport)
    , exec_(exec)
    , outgoing_(exec, name, transport.carrier())
    , incoming_(exec, name, transport.carrier())
    , name_(name)
    , channel_(transport.open_channel())
{
}

template<class Exec>
void Messages<Exec>::start(const MessageRanges& out, const MessageRanges& in)
{
    turn_ = (turn_ + 1) % turns;
    requests_.clear();
    expected_.clear();
    partners_.clear();
    if (out.empty() && in.empty()) { return; }
    if (transport_->carrier() == Carrier::nccl)
    {
        if constexpr (is_gpu<Exec>) { transport_->nccl().exchange(exec_, out, outgoing_.data(), in, incoming_.data()); }
        return;
    }
    leaving_ = out;
    coming_  = in;
    if constexpr (!is_gpu<Exec>) { post(); }
}

template<class Exec>
void Messages<Exec>::post()
{
    // Outgoing bytes must be written, and the last incoming ones read, before they are reused.
    synchronize(exec_);
    for (const MessageRange& range : coming_) { post_receive(range); }
    for (const MessageRange& range : leaving_) { post_send(range); }
    coming_.clear();
    leaving_.clear();
}

template<class Exec>
void Messages<Exec>::post_receive(const MessageRange& range)
{
    const auto receive = [&](std::int64_t first, int bytes)
    {
        check_mpi(MPI_Irecv(incoming_.data() + first, bytes, MPI_BYTE, range.rank, channel_ * turns + turn_,
                            transport_->communicator().native(), &requests_.emplace_back()),
                  "receive");
        partners_.push_back(range.rank);
        expected_.push_back({range.rank, first, bytes});
    };
    for_each_piece(range, receive);
}

template<class Exec>
void Messages<Exec>::post_send(const MessageRange& range)
{
    const auto send = [&](std::int64_t first, int bytes)
    {
        check_mpi(MPI_Isend(outgoing_.data() + first, bytes, MPI_BYTE, range.rank, channel_ * turns + turn_,
                            transport_->communicator().native(), &requests_.emplace_back()),
                  "send");
        partners_.push_back(range.rank);
    };
    for_each_piece(range, send);
}

template<class Exec>
void Messages<Exec>::wait_for_all()
{
    std::sort(partners_.begin(), partners_.end());
    partners_.erase(std::unique(partners_.begin(), partners_.end()), partners_.end());
    const Waiting wait(transport_->communicator().waits(), name_, partners_);
    check_mpi(MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), states_.data()), "messages");
}

template<class Exec>
void Messages<Exec>::finish()
{
    if (!leaving_.empty() || !coming_.empty()) { post(); }
    if (requests_.empty()) { return; }
    states_.resize(requests_.size());
    wait_for_all();
    for (std::size_t i = 0; i < expected_.size(); ++i)
    {
        int bytes = 0;
        MPI_Get_count(&states_[i], MPI_BYTE, &bytes);
        if (bytes == expected_[i].bytes) { continue; }
        throw EnvironmentError(
            fmt::format("MPI: {} bytes came from rank {}, not {}", bytes, expected_[i].rank, expected_[i].bytes));
    }
    requests_.clear();
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template class Transport<Exec>;                                                                                    \
    template class Messages<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
