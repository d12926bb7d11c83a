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

/// What the user may ask for. All give the same bits.
enum class TransportChoice
{
    automatic, ///< the first that works of: MPI from GPU memory, NCCL, pinned host memory; CPUs always take MPI
    mpi,
    nccl,
    host
};

/// What moves bytes between the ranks of a run from and to a backend's memory. Collective: every rank makes the same
/// calls in the same order.
template<class Exec>
class Transport
{
public:
    /// EnvironmentError when what is asked for does not work here.
    Transport(const Communicator& communicator, const Exec& exec, TransportChoice choice);

    const Communicator& communicator() const { return communicator_; }
    const Exec&         exec() const { return exec_; }
    Nccl&               nccl() { return *nccl_; }
    Carrier             carrier() const { return carrier_; }

    /// "pinned host memory (this MPI does not know GPUs)", for the log.
    const std::string& description() const { return description_; }

    /// A number for one more kind of message, so that none meets another's.
    int open_channel();

private:
    const Communicator&   communicator_;
    Exec                  exec_;
    std::unique_ptr<Nccl> nccl_; ///< only if that is the carrier
    Carrier               carrier_;
    std::string           description_;
    int                   channels_ = 0;
};

/// Messages of one kind between this rank and others: one set may be under way at a time. Nothing is allocated once
/// buffers are large enough.
template<class Exec>
class Messages
{
public:
    /// `exec`: where the kernels run that write and read the messages, and NCCL.
    Messages(Transport<Exec>& transport, const Exec& exec, const char* name);

    /// Memory for what goes out, and for what comes in, which kernels of the backend write and read. `bytes` at least;
    /// nothing may be under way.
    std::byte* outgoing(std::int64_t bytes) { return outgoing_.reserve(bytes); }
    std::byte* incoming(std::int64_t bytes) { return incoming_.reserve(bytes); }

    /// From now on ranks that have messages for each other depart equally often, however often they did before.
    void count_anew() { turn_ = 0; }

    /// Starts sending what kernels that were launched before have written to the outgoing buffer; from a GPU through
    /// MPI, which would have to wait for them here, in arrive().
    void start(const MessageRanges& out, const MessageRanges& in);

    /// When it returns, kernels may read the incoming buffer and write the outgoing one. EnvironmentError when MPI
    /// reports one or another rank sent less than was to come.
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
    MessageRanges            coming_;   ///< the same
    MessageRanges            expected_; ///< of the first requests
    std::vector<int>         partners_; ///< of all of them
    const char*              name_;     ///< for a watchdog
    int                      channel_;
    int                      turn_ = 0;
};

} // namespace tread::decomp
