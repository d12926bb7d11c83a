#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "kernels/contact/summary.hpp"
#include "solver/ledger/measuring.hpp"
#include "solver/touch_change.hpp"

namespace tread::solver
{

/// Throws NumericalError when the substeps that the scene fixes were so long that contacts of bodies gain energy.
/// `pace`: after that step.
void require_stable_substep(const LastStep& last, const Pace& pace);

/// Throws NumericalError when a point is so deep in a body that its nearest surface is not unique. `name_of`: names a
/// body in the message; `time`: s.
void require_unique_surface(const contact::Summary& contacts, const std::function<std::string(std::int64_t)>& name_of,
                            double time);

/// Throws NumericalError: points of sand overlap a body when `phase` begins, in which the two begin to touch.
[[noreturn]] void refuse_new_touch(const NewTouch& found, const std::string& body, const std::string& phase,
                                   double time);

} // namespace tread::solver
