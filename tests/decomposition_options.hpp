#pragma once

#include <cstdlib>
#include <string>

#include "decomp/decomposition.hpp"

// TREAD_TEST_TRANSPORT=host moves messages between GPUs through pinned host memory, where else the first transport is
// taken that works.
namespace tread::test
{

/// With checksums of the points that ranks exchange.
inline decomp::DecompositionOptions decomposition_options()
{
    const char* wanted  = std::getenv("TREAD_TEST_TRANSPORT");
    const bool  by_host = wanted != nullptr && std::string(wanted) == "host";
    return {by_host ? decomp::TransportChoice::host : decomp::TransportChoice::automatic, decomp::Checksums::on};
}

} // namespace tread::test
