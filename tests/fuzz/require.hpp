#pragma once

#include <cstdlib>

namespace tread::fuzz
{

/// Ends the process unless `holds`, which the fuzzer takes for a find.
inline void require(bool holds)
{
    if (!holds) { std::abort(); }
}

} // namespace tread::fuzz
