#include "solver/ledger/contact_guards.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread::solver
{
namespace
{

constexpr double longest_substep =
    0.8; ///< dt/N over sqrt(m / sum K): beyond it a contact gains energy (docs/theory.md#time-step)
constexpr double least_gradient = 0.5; ///< |grad phi| in contact below which a point is past the medial axis

} // namespace

void require_stable_substep(const LastStep& last, const Pace& pace)
{
    const double substep = last.step.dt / static_cast<double>(last.step.substeps);
    if (pace.shortest_contact <= 0 || substep <= longest_substep * pace.shortest_contact) { return; }
    throw NumericalError(
        fmt::format("t = {:.6g} s: a substep of {:.4g} s is {:.3g} of a body's sqrt(m / sum K), over the "
                    "{} at which its contacts gain energy: more substeps, or a smaller dt",
                    last.time, substep, substep / pace.shortest_contact, longest_substep));
}

void require_unique_surface(const contact::Summary& contacts, const std::function<std::string(std::int64_t)>& name_of,
                            double time)
{
    if (contacts.live == 0 || contacts.flattest.value >= least_gradient) { return; }
    throw NumericalError(fmt::format("t = {:.6g} s: point {} is so deep in body {} that its nearest surface is "
                                     "not unique (|grad phi| = {:.2g}, "
                                     "least {}): a smaller dt, or a finer grid beside thin walls",
                                     time, contacts.flattest.point_id, name_of(contacts.flattest.body),
                                     contacts.flattest.value, least_gradient));
}

void refuse_new_touch(const NewTouch& found, const std::string& body, const std::string& phase, double time)
{
    throw NumericalError(fmt::format("t = {:.6g} s: body {} and sand begin to touch in phase '{}', and {} points of "
                                     "sand overlap it, by up to {:.3g} m; accepted: at most {:.3g} m, so that the "
                                     "contact does not throw them apart: move the body out of the sand before the "
                                     "phase",
                                     time, body, phase, found.points, found.overlap, found.most));
}

} // namespace tread::solver
