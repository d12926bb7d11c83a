#pragma once

#include "backend_choice.hpp"
#include "base/communicator.hpp"
#include "decomp/transport.hpp"

namespace tread::bench
{

struct MessagesCase
{
    decomp::TransportChoice transport = decomp::TransportChoice::automatic;
    Backend                 backend   = Backend::cpu;
    int                     rounds    = 200; ///< timed, three times
};

/// What the two designs of a wheel that several ranks touch send: what they tell each other of shared bodies in every
/// substep, beside the points near the wheel that would go to one rank once a step, and their impulses back. Prints the
/// times; nothing else is computed.
void run_messages(const Communicator& communicator, const MessagesCase& what);

} // namespace tread::bench
