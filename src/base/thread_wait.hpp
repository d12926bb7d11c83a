#pragma once

namespace tread
{

/// Starts the process anew with a limit on how long idle OpenMP threads spin before they sleep, unless the environment
/// has a rule of its own (OMP_WAIT_POLICY, GOMP_SPINCOUNT). `arguments`: those of main. Call it first in main: GNU's
/// OpenMP reads its environment before. Where processes share cores, threads that spin for long keep each other from
/// working (docs/performance.md). Returns if nothing is to be done, or if the process cannot be started anew.
void limit_spinning(char** arguments);

} // namespace tread
