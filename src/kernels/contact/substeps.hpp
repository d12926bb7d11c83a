#pragma once

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/motion/move.hpp"

namespace tread::contact
{

/// Whether there are so few contacts that launch latency would dominate the substeps. Always false on the host, where
/// launches are free.
inline bool worth_one_launch(const Cpu&, PointContact<Cpu>&, const dem::BodyStep<Cpu>&) { return false; }
bool        worth_one_launch(const Gpu&, PointContact<Gpu>& contact, const dem::BodyStep<Gpu>& step);

/// Runs substep, dem::evaluate_contacts (if there are pairs) and dem::move_bodies `count` times with step.motion.dt (s)
/// and contact.wrenches() as external wrenches. On a GPU this is one launch (that of bodies alone if no sand is near
/// them); call it only if worth_one_launch. The host version is the reference of tests. Allocates nothing.
void run_substeps(const Cpu&, PointContact<Cpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Cpu>& step,
                  std::int64_t count);
void run_substeps(const Gpu&, PointContact<Gpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Gpu>& step,
                  std::int64_t count);

} // namespace tread::contact
