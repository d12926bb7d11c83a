#include "run/phase_end.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/spelling.hpp"
#include "solver/state_file.hpp"

template<>
inline constexpr auto tread::scene::spellings<tread::run::EndKind> =
    tread::scene::spell<tread::run::EndKind>({{tread::run::EndKind::running, "running"},
                                              {tread::run::EndKind::duration, "duration"},
                                              {tread::run::EndKind::settled, "settled"},
                                              {tread::run::EndKind::unsettled, "not settled"},
                                              {tread::run::EndKind::lowered, "lowered"},
                                              {tread::run::EndKind::unlowered, "not lowered"},
                                              {tread::run::EndKind::end_of_bed, "end of the bed"},
                                              {tread::run::EndKind::stopped, "stop reached"},
                                              {tread::run::EndKind::unstopped, "stop not reached"}});

namespace tread::run
{
namespace
{

constexpr double never = std::numeric_limits<double>::infinity();

/// Whether the ground carries the wanted share of a body that is lowered.
bool is_lowered(const scene::Lower& lower, const PhaseEndWatch& watch) { return watch.carried.share >= lower.share; }

/// Notes whether the state is near equilibrium at `time`; returns whether it has been for long enough.
bool has_settled(PhaseEndWatch& watch, double time, double unbalanced)
{
    watch.still_since = unbalanced > equilibrium_ratio ? never : std::min(watch.still_since, time);
    return time - watch.still_since >= equilibrium_hold;
}

} // namespace

const char* name_of(EndKind kind) { return scene::word_of(kind); }

EndKind end_kind(const std::string& name)
{
    for (const auto& [kind, word] : scene::spellings<EndKind>)
    {
        if (name == word) { return kind; }
    }
    return EndKind::running;
}

bool deserves_warning(EndKind kind)
{
    return kind == EndKind::unsettled || kind == EndKind::unlowered || kind == EndKind::end_of_bed ||
           kind == EndKind::unstopped;
}

std::string describe(const PhaseEnd& end)
{
    switch (end.kind)
    {
    case EndKind::settled:
        return fmt::format("settled after {:.4g} s (unbalanced force {:.2g} of the weight)", end.after, end.unbalanced);
    case EndKind::unsettled:
        return fmt::format("NOT settled after its max_duration of {:.4g} s: unbalanced force {:.2g} of the weight, "
                           "wanted {:.2g}",
                           end.after, end.unbalanced, equilibrium_ratio);
    case EndKind::lowered:
        return fmt::format("the ground carries {:.3g} % of '{}' after {:.4g} s", 100 * end.carried, end.body,
                           end.after);
    case EndKind::unlowered:
        return fmt::format("NOT lowered after its max_duration of {:.4g} s: the ground carries {:.3g} % of '{}'",
                           end.after, 100 * end.carried, end.body);
    case EndKind::end_of_bed:
        return fmt::format("'{}' reached the end of the bed after {:.4g} s: {}", end.body, end.after, end.place);
    case EndKind::stopped:
        return fmt::format("'{}' reached {} after {:.4g} s", end.body, end.place, end.after);
    case EndKind::unstopped:
        return fmt::format("NO stop reached within its duration of {:.4g} s", end.after);
    case EndKind::duration:
        return fmt::format("after {:.4g} s", end.after);
    case EndKind::running:
        break;
    }
    return fmt::format("runs since {:.4g} s", end.after);
}

void CarriedShare::note(double time, double integral)
{
    const double since = time - last;
    if (last >= 0 && since > 0)
    {
        const double now = (integral - carried) / since;
        share -= std::expm1(-since / span) * (now - share);
    }
    last    = time;
    carried = integral;
}

bool is_over(const scene::Scene& scene, const RunningPhase& phase, PhaseEndWatch& watch, double time, double unbalanced)
{
    const scene::Phase& keys        = keys_of(scene, phase);
    const bool          late        = time >= latest_end(scene, phase) - time_rounding;
    const auto          end_if_late = [&](EndKind kind) { return late ? kind : EndKind::running; };
    watch.ending                    = {EndKind::running, time - phase.start, unbalanced};
    switch (keys.until)
    {
    case scene::StopRule::duration:
        watch.ending.kind = end_if_late(EndKind::duration);
        break;
    case scene::StopRule::lowered:
        watch.ending.body    = keys.lower->body;
        watch.ending.carried = watch.carried.share;
        watch.ending.kind    = is_lowered(*keys.lower, watch) ? EndKind::lowered : end_if_late(EndKind::unlowered);
        break;
    case scene::StopRule::equilibrium:
        watch.ending.kind = has_settled(watch, time, unbalanced) ? EndKind::settled : end_if_late(EndKind::unsettled);
        break;
    }
    return watch.ending.kind != EndKind::running;
}

void transfer(solver::StateFile& file, const scene::Scene& scene, RunningPhase& phase, PhaseEndWatch& watch)
{
    const auto last    = static_cast<double>(scene.phases.size()) - 1;
    auto&      carried = watch.carried;
    file.numbers("phases/now", solver::accept::number(phase.index, 0, last), phase.start,
                 solver::accept::number(watch.still_since, -solver::accept::largest, never),
                 solver::accept::number(watch.ending.kind, 0, static_cast<double>(EndKind::unstopped)),
                 watch.ending.after, watch.ending.unbalanced);
    file.numbers("phases/carried", carried.last, carried.carried, carried.share);
    file.common("phases/start_spins", phase.start_spins,
                solver::accept::all(solver::accept::rows(phase.start_spins.size()), solver::accept::finite()));
}

} // namespace tread::run
