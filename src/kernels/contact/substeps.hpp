#pragma once

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/move.hpp"

namespace tread::contact
{

/// substep, dem::evaluate_contacts where there are pairs, and dem::move_bodies, `count` times, with step.motion.dt (s),
/// without the host: where so little meets that waiting between launches would be most of the substeps. Else, and on
/// the host, where a launch costs nothing, does nothing and returns false. Allocates nothing.
inline bool run_in_one_launch(const Cpu&, PointContact<Cpu>&, const PointBodyLaw&, const dem::BodyStep<Cpu>&,
                              std::int64_t)
{
    return false;
}
bool run_in_one_launch(const Gpu&, PointContact<Gpu>& contact, const PointBodyLaw& law, const dem::BodyStep<Gpu>& step,
                       std::int64_t count);

} // namespace tread::contact
