#pragma once

#include "kernels/dem/move.hpp"

namespace tread::dem
{

/// evaluate_contacts and move_bodies, `count` times, with motion.dt (s). The host has no part in them. Allocates
/// nothing.
void run_substeps(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                  const NamedImpulses& named, const Motion& motion, std::int64_t count);
void run_substeps(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law, BodyTotal* totals,
                  const NamedImpulses& named, const Motion& motion, std::int64_t count);

} // namespace tread::dem
