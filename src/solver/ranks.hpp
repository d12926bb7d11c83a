#pragma once

#include "decomp/territory.hpp"
#include "decomp/transport.hpp"

namespace tread::solver
{

/// What the parts of a simulation need of the other ranks of a run; a run on one rank has none.
template<class Exec>
struct Ranks
{
    decomp::Transport<Exec>& transport;
    decomp::Territory&       territory;

    const Communicator& communicator() const { return transport.communicator(); }
};

} // namespace tread::solver
