#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <mpi.h>

#include "backend/array.hpp"
#include "base/communicator.hpp"
#include "decomp/message_buffer.hpp"
#include "decomp/message_range.hpp"
#include "decomp/nccl.hpp"

namespace tread::decomp
{

/// Transport that the user requests. All give the same bits.
enum class TransportChoice
{
    automatic, ///< the first that works of MPI from GPU memory, NCCL and pinned host memory; CPUs always use MPI
    mpi,
    nccl,
    host
};

/// Moves bytes between ranks, from and to a backend's memory. Collective: every rank makes the same calls in the same
/// order.
template<class Exec>
class Transport
{
public:
    /// EnvironmentError if the requested transport does not work here.
    Transport(const Communicator& communicator, const Exec& exec, TransportChoice choice);

    const Communicator& communicator() const { return communicator_; }
    const Exec&         exec() const { return exec_; }
    Nccl&               nccl() { return *nccl_; }
    Carrier             carrier() const { return carrier_; }

    /// "pinned host memory (this MPI does not know GPUs)", for the log.
    const std::string& description() const { return description_; }

    /// Replaces a number in the backend's memory by the largest of all ranks, in order with launches. NCCL does so
    /// without the host; else it waits.
    void largest(std::int32_t* number);

    /// Returns a new channel number, so that messages of different kinds never match each other.
    int open_channel();

private:
    const Communicator&   communicator_;
    Exec                  exec_;
    std::unique_ptr<Nccl> nccl_; ///< only if that is the carrier
    Carrier               carrier_;
    std::string           description_;
    int                   channels_ = 0;
};

/// Messages of one kind between this rank and others; one set may be in flight at a time. Nothing is allocated once the
/// buffers are large enough.
template<class Exec>
class Messages
{
public:
    /// `exec`: stream of the kernels that write and read the messages, and of NCCL.
    Messages(Transport<Exec>& transport, const Exec& exec, const char* name);

    /// Buffers of at least `bytes` for outgoing and incoming messages, which kernels of the backend write and read. No
    /// message may be in flight.
    std::byte* outgoing(std::int64_t bytes) { return outgoing_.reserve(bytes); }
    std::byte* incoming(std::int64_t bytes) { return incoming_.reserve(bytes); }

    /// Resets the turn counter, so that ranks that exchange messages count turns alike from now on.
    void count_anew() { turn_ = 0; }

    /// Starts sending what previously launched kernels write to the outgoing buffer. From a GPU through MPI, sending is
    /// deferred to finish(), as it would have to wait for the kernels here.
    void start(const MessageRanges& out, const MessageRanges& in);

    /// Waits for all messages; then kernels may read the incoming buffer and write the outgoing one. EnvironmentError
    /// if MPI reports an error or another rank sent less than expected.
    void finish();

private:
    void post();
    void post_receive(const MessageRange& range);
    void post_send(const MessageRange& range);
    void wait_for_all();

    Transport<Exec>*         transport_;
    Exec                     exec_;
    MessageBuffer<Exec>      outgoing_;
    MessageBuffer<Exec>      incoming_;
    std::vector<MPI_Request> requests_;
    std::vector<MPI_Status>  states_;
    MessageRanges            leaving_;  ///< not yet posted
    MessageRanges            coming_;   ///< not yet posted
    MessageRanges            expected_; ///< of the first requests
    std::vector<int>         partners_; ///< rank of each request
    const char*              name_;     ///< for the watchdog
    int                      channel_;
    int                      turn_ = 0;
};

} // namespace tread::decomp
