#pragma once

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/motion/move.hpp"

namespace tread::contact
{

/// Whether so little meets that waiting between launches would be most of the substeps. Never on the host, where a
/// launch costs nothing.
inline bool worth_one_launch(const Cpu&, PointContact<Cpu>&, const dem::BodyStep<Cpu>&) { return false; }
bool        worth_one_launch(const Gpu&, PointContact<Gpu>& contact, const dem::BodyStep<Gpu>& step);

/// substep, dem::evaluate_contacts where there are pairs, and dem::move_bodies, `count` times, with step.motion.dt (s)
/// and contact.wrenches() from outside. A GPU does them in one launch, that of bodies alone where no sand is near them,
/// and may be asked only where that is worth it; the host's are what it is tested against. Allocates nothing.
void run_substeps(const Cpu&, PointContact<Cpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Cpu>& step,
                  std::int64_t count);
void run_substeps(const Gpu&, PointContact<Gpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Gpu>& step,
                  std::int64_t count);

} // namespace tread::contact
