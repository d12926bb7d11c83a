#pragma once

#include "kernels/dem/motion/move.hpp"

namespace tread::dem
{

/// Runs evaluate_contacts and move_bodies `count` times with motion.dt (s), without host work in between. Allocates
/// nothing.
void run_substeps(const Cpu&, const BodyStep<Cpu>& step, std::int64_t count);
void run_substeps(const Gpu&, const BodyStep<Gpu>& step, std::int64_t count);

} // namespace tread::dem
