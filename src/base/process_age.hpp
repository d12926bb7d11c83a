#pragma once

namespace tread
{

/// s since this process began, by the kernel's books (to 10 ms): loading libraries and joining MPI come before the
/// first line of main, and take seconds on a busy machine. 0 where the kernel does not say.
double process_age();

} // namespace tread
