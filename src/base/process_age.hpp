#pragma once

namespace tread
{

/// Seconds since the kernel started this process (to 10 ms). Loading libraries and joining MPI precede main, and take
/// seconds on a busy machine. 0 if the kernel does not report it.
double process_age();

} // namespace tread
