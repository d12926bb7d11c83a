#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "run/driver.hpp"
#include "world/packing.hpp"

// Beginning and end of the phases of a run.
namespace tread::run
{

/// Returns the end of the phase if its drive is at the end of the bed. Also checks that the driven bodies are on the
/// terrain. Reads their positions only when one of them can have reached one of these limits.
template<class Exec, class Real>
std::optional<PhaseEnd> Driver<Exec, Real>::end_of_bed()
{
    if (!simulation_.measured() || rooms_.empty()) { return {}; }
    const double time = loop_.progress.time;
    drive_watch_.note_speed(time, simulation_.pace().largest_speed);
    if (!drive_watch_.is_due()) { return {}; }
    const auto&   drive = keys_of(scene_, loop_.phase).drive;
    const WayEnd* end   = nullptr;
    double        left  = std::numeric_limits<double>::infinity();
    for (const DriveRoom& room : rooms_)
    {
        const Vec3<double> axle = simulation_.place(room.body);
        require_on_terrain(room, axle);
        left = std::min(left, distance_to_leave(room, axle));
        if (!drive || scene_.bodies[room.body].name != drive->body) { continue; }
        end  = reached_end(room, *drive, axle[0]);
        left = std::min(left, distance_to_end(room, *drive, axle[0]));
    }
    drive_watch_.set_distance_left(left);
    if (end == nullptr) { return {}; }
    return PhaseEnd{EndKind::end_of_bed, time - loop_.phase.start, simulation_.unbalanced(), drive->body, 0, end->what};
}

/// Throws NumericalError where a driven body has rolled off the terrain: its answers would be meaningless.
template<class Exec, class Real>
void Driver<Exec, Real>::require_on_terrain(const DriveRoom& room, const Vec3<double>& axle) const
{
    if (!has_left(room, axle)) { return; }
    throw NumericalError(fmt::format("t = {:.6g} s: '{}' has left the terrain: its axle is at [{:.4g}, {:.4g}, "
                                     "{:.4g}] m; a longer bed, closed walls, or a shorter drive",
                                     loop_.progress.time, scene_.bodies[room.body].name, axle[0], axle[1], axle[2]));
}

template<class Exec, class Real>
void Driver<Exec, Real>::begin_phase()
{
    log_.info(fmt::format("phase '{}' begins at {:.6g} s", keys_of(scene_, loop_.phase).name, loop_.progress.time));
    require_independent_axes(scene_, loop_.phase, loop_.motions, loop_.progress.time);
    output_.begin_phase();
    drive_watch_.reset();
    messages_.warned = false;
}

template<class Exec, class Real>
void Driver<Exec, Real>::end_phase()
{
    const scene::Phase& phase = keys_of(scene_, loop_.phase);
    const PhaseEnd&     end   = loop_.watch.ending;
    const std::string   line  = fmt::format("phase '{}' ends: {}", phase.name, describe(end));
    if (deserves_warning(end.kind)) { log_.warning(line); }
    else { log_.info(line); }
    std::optional<bool> settled;
    if (phase.until == scene::StopRule::equilibrium) { settled = end.kind == EndKind::settled; }
    io::PhaseReport report{phase.name, loop_.phase.start, end.after, name_of(end.kind), settled, end.unbalanced, {}};
    const bool      saves = phase.name == scene_.output.bed_after;
    if (plan_.rocks && !plan_.sand && (settled || saves))
    {
        report.packing_fraction =
            world::packing_fraction(world_, io::gathered(communicator_, simulation_.body_fields()));
        log_.info(fmt::format("packing fraction of the rocks {:.4f}", *report.packing_fraction));
    }
    ended_.push_back(report);
    if (saves) { log_.info(output_.write_bed()); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template std::optional<PhaseEnd> Driver<Exec, Real>::end_of_bed();                                                 \
    template void                    Driver<Exec, Real>::begin_phase();                                                \
    template void                    Driver<Exec, Real>::end_phase()
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
