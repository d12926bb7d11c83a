#include "decomp/transport.hpp"

#include <algorithm>

#include <fmt/format.h>
#if __has_include(<mpi-ext.h>)
#include <mpi-ext.h>
#endif

namespace tread::decomp
{
namespace
{

// MPI promises tags up to 32767; the turns of a channel differ, so that a rank that is a step ahead is noticed.
constexpr int turns         = 64;
constexpr int most_channels = 32768 / turns;

// MPI counts in int.
constexpr std::int64_t most_bytes_a_message = std::int64_t{1} << 30;

struct Choice
{
    Carrier     carrier;
    std::string description;
};

Choice choose(const Cpu&, const Communicator&, TransportChoice) { return {Carrier::mpi, "MPI"}; }

#ifdef TREAD_WITH_CUDA
bool mpi_knows_gpus()
{
#if defined(OMPI_HAVE_MPI_EXT_CUDA) && OMPI_HAVE_MPI_EXT_CUDA
    return MPIX_Query_cuda_support() == 1;
#else
    return false;
#endif
}

/// Every rank must come to the same answer: what one MPI library can, all ranks' must.
Choice choose(const Gpu&, const Communicator& communicator, TransportChoice choice)
{
    const bool aware = communicator.maximum(mpi_knows_gpus() ? 0 : 1) == 0;
    if (choice == TransportChoice::mpi && !aware)
    {
        throw EnvironmentError("--transport mpi: this MPI cannot send from GPU memory (MPIX_Query_cuda_support)");
    }
    if (choice == TransportChoice::host) { return {Carrier::host, "MPI through pinned host memory"}; }
    if (aware) { return {Carrier::mpi, "MPI from GPU memory"}; }
    return {Carrier::host, "MPI through pinned host memory (this MPI cannot send from GPU memory)"};
}
#endif

} // namespace

template<class Exec>
Transport<Exec>::Transport(const Communicator& communicator, const Exec& exec, TransportChoice choice)
    : communicator_(communicator)
    , exec_(exec)
{
    Choice chosen = choose(exec, communicator, choice);
    carrier_      = chosen.carrier;
    description_  = std::move(chosen.description);
}

template<class Exec>
int Transport<Exec>::open_channel()
{
    if (channels_ == most_channels) { throw EnvironmentError("transport: too many kinds of messages"); }
    return channels_++;
}

template<class Exec>
Mail<Exec>::Mail(Transport<Exec>& transport, const char* name)
    : transport_(&transport)
    , outgoing_(transport.exec(), name, transport.carrier())
    , incoming_(transport.exec(), name, transport.carrier())
    , channel_(transport.open_channel())
{
}

template<class Exec>
void Mail<Exec>::depart(const std::vector<Parcel>& out, const std::vector<Parcel>& in)
{
    turn_ = (turn_ + 1) % turns;
    requests_.clear();
    expected_.clear();
    if (out.empty() && in.empty()) { return; }
    // What is to go must be written, and what came last must have been read.
    synchronize(transport_->exec());
    for (const Parcel& parcel : in) { post(parcel, false); }
    for (const Parcel& parcel : out) { post(parcel, true); }
}

/// In pieces that MPI can count; they arrive in the order in which they are sent.
template<class Exec>
void Mail<Exec>::post(const Parcel& parcel, bool out)
{
    const int tag = channel_ * turns + turn_;
    for (std::int64_t done = 0; done < parcel.bytes; done += most_bytes_a_message)
    {
        const auto  bytes  = static_cast<int>(std::min(most_bytes_a_message, parcel.bytes - done));
        const auto  first  = parcel.first + done;
        const auto& native = transport_->communicator().native();
        requests_.emplace_back();
        if (out)
        {
            check_mpi(MPI_Isend(outgoing_.data() + first, bytes, MPI_BYTE, parcel.rank, tag, native, &requests_.back()),
                      "send");
            continue;
        }
        check_mpi(MPI_Irecv(incoming_.data() + first, bytes, MPI_BYTE, parcel.rank, tag, native, &requests_.back()),
                  "receive");
        expected_.push_back({parcel.rank, first, bytes});
    }
}

template<class Exec>
void Mail<Exec>::arrive()
{
    if (requests_.empty()) { return; }
    states_.resize(requests_.size());
    check_mpi(MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), states_.data()), "messages");
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

template class Transport<Cpu>;
template class Mail<Cpu>;
#ifdef TREAD_WITH_CUDA
template class Transport<Gpu>;
template class Mail<Gpu>;
#endif

} // namespace tread::decomp
