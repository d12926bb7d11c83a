#include "solver/ledger/extremes.hpp"

#include <algorithm>
#include <string>

#include "solver/state_file.hpp"

namespace tread::solver
{

void Extremes::note(const TimeStep& step, std::int64_t steps, const PaceLimits& limits, const Pace& pace,
                    const contact::Summary& contacts)
{
    const double shortest = pace.shortest_contact;
    if (limits.spacing > 0)
    {
        courant      = std::max(courant, limits.wave_speed * step.dt / limits.spacing);
        displacement = std::max(displacement, pace.largest_speed * step.dt / limits.spacing);
    }
    spring        = std::max(spring, pace.stiffest_point * step.dt * step.dt);
    body_overlap  = std::max(body_overlap, pace.overlap);
    point_overlap = std::max(point_overlap, contacts.deepest.value);
    if (shortest > 0) { substep = std::max(substep, step.dt / static_cast<double>(step.substeps) / shortest); }
    if (contacts.live_named == 0) { return; }
    const double span = step.dt * static_cast<double>(steps);
    touched += span;
    touching += span * static_cast<double>(contacts.live_named);
}

void Extremes::transfer(StateFile& file)
{
    const auto field = [&](const std::string& name, double& value)
    { file.numbers("extremes/" + name, accept::number(value, 0, accept::largest)); };
    field("courant", courant);
    field("displacement", displacement);
    field("spring", spring);
    field("substep", substep);
    field("body_overlap", body_overlap);
    field("point_overlap", point_overlap);
    field("touched", touched);
    field("touching", touching);
}

} // namespace tread::solver
