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

/// Times the messages of two designs for a wheel touched by several ranks: exchange of shared bodies' forces in every
/// substep, against sending the points near the wheel to one rank once per step and their impulses back. Prints the
/// times; nothing else is computed.
void run_messages(const Communicator& communicator, const MessagesCase& what);

} // namespace tread::bench
