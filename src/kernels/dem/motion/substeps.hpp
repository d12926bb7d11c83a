#pragma once

#include "kernels/dem/motion/move.hpp"

namespace tread::dem
{

/// Runs evaluate_contacts and move_bodies `count` times with motion.dt (s), without host work in between; fewer times
/// where step.limit is reached and the execution tag skips launches from then on. Allocates nothing.
template<class Exec>
void run_substeps(const Exec&, const BodyStep<Exec>& step, std::int64_t count);

} // namespace tread::dem
