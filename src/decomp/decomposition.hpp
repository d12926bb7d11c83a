#pragma once

#include "decomp/page_map.hpp"
#include "decomp/transport.hpp"

namespace tread::decomp
{

/// Whether counts, ids and masses of all ranks' points are compared before and after a migration.
enum class Checksums
{
    off,
    on
};

struct DecompositionOptions
{
    TransportChoice transport = TransportChoice::automatic;
    Checksums       checksums = Checksums::off;
};

/// State shared by all parts of a run on several ranks. A run on one rank has none.
template<class Exec>
struct Decomposition
{
    Decomposition(const Communicator& all, const Exec& exec, const DecompositionOptions& options)
        : communicator(all)
        , transport(all, exec, options.transport)
        , owners(exec)
        , checksums(options.checksums)
    {
    }

    int rank() const { return communicator.rank(); }
    int ranks() const { return communicator.size(); }

    const Communicator& communicator;
    Transport<Exec>     transport;
    PageMap<Exec>       owners;
    Checksums           checksums;
};

} // namespace tread::decomp
