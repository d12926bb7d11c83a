#pragma once

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/motion/move.hpp"

namespace tread::contact
{

/// Whether there are so few contacts that launch latency would dominate the substeps. Always false on the host, where
/// launches are free.
template<class Exec>
bool worth_one_launch(const Exec&, PointContact<Exec>& contact, const dem::BodyStep<Exec>& step);

/// Runs substep, dem::evaluate_contacts (if there are pairs) and dem::move_bodies `count` times with step.motion.dt (s)
/// and contact.wrenches() as external wrenches. On a GPU this is one launch (that of bodies alone if no sand is near
/// them); call it only if worth_one_launch. Ends with step.limit.last. The host version is the reference of tests.
/// Allocates nothing.
template<class Exec>
void run_substeps(const Exec&, PointContact<Exec>& contact, const PointBodyLaw& law, const dem::BodyStep<Exec>& step,
                  std::int64_t count);

} // namespace tread::contact
