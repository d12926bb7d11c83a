#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "run/driver.hpp"
#include "world/packing.hpp"
#include "world/saved_bed.hpp"
#include "world/saved_sand.hpp"

// Phase transitions of a run.
namespace tread::run
{

/// Advances to the next phase if this one is over, and skips phases that would continue beyond the end of the bed.
template<class Exec, class Real>
void Driver<Exec, Real>::pass_on()
{
    bool over = phase_is_over();
    while (over)
    {
        end_phase();
        std::vector<double> spins;
        for (const solver::BodyRow& body : simulation_.named_bodies())
        {
            spins.push_back(body.angular_velocity.dot(body.axle));
        }
        phases_.advance(time_, std::move(spins));
        if (phases_.finished()) { return; }
        begin_phase();
        over = is_at_end_of_bed();
    }
}

template<class Exec, class Real>
bool Driver<Exec, Real>::phase_is_over()
{
    if (const auto body = phases_.lowered(); body && simulation_.measured())
    {
        phases_.weigh(time_, simulation_.carried(*body));
    }
    return is_at_end_of_bed() || phases_.over(time_, simulation_.unbalanced());
}

/// Whether the drive is at the end of the bed. Also checks that the driven bodies are on the terrain. Reads their
/// positions only when one of them can have reached one of these limits.
template<class Exec, class Real>
bool Driver<Exec, Real>::is_at_end_of_bed()
{
    if (!simulation_.measured() || rooms_.empty()) { return false; }
    drive_watch_.note_speed(time_, simulation_.pace().largest_speed);
    if (!drive_watch_.is_due()) { return false; }
    const auto&   drive = phases_.phase().drive;
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
    if (end != nullptr) { phases_.end_of_bed(time_, simulation_.unbalanced(), end->what); }
    return end != nullptr;
}

/// Throws NumericalError where a driven body has rolled off the terrain: its answers would be meaningless.
template<class Exec, class Real>
void Driver<Exec, Real>::require_on_terrain(const DriveRoom& room, const Vec3<double>& axle) const
{
    if (!has_left(room, axle)) { return; }
    throw NumericalError(fmt::format("t = {:.6g} s: '{}' has left the terrain: its axle is at [{:.4g}, {:.4g}, "
                                     "{:.4g}] m; a longer bed, closed walls, or a shorter drive",
                                     time_, scene_.bodies[room.body].name, axle[0], axle[1], axle[2]));
}

template<class Exec, class Real>
void Driver<Exec, Real>::begin_phase()
{
    log_.info(fmt::format("phase '{}' begins at {:.6g} s", phases_.phase().name, time_));
    const std::vector<solver::BodyRow> bodies = simulation_.named_bodies();
    surface_.press(bodies);
    surface_.renew(simulation_.surface_heights(surface_.lattice()));
    surface_.press(bodies);
    on_root(communicator_, [&] { recorder_->begin_phase(phases_.index(), time_); });
    drive_watch_.reset();
    warned_ = false;
}

template<class Exec, class Real>
void Driver<Exec, Real>::end_phase()
{
    const PhaseEnd&   end  = phases_.ending();
    const std::string line = fmt::format("phase '{}' ends: {}", phases_.phase().name, describe(end));
    if (deserves_warning(end.kind)) { log_.warning(line); }
    else { log_.info(line); }
    std::optional<bool> settled;
    if (phases_.phase().until == scene::StopRule::equilibrium) { settled = end.kind == EndKind::settled; }
    io::PhaseReport report{phases_.phase().name, phases_.start(), end.after, name_of(end.kind), settled,
                           end.unbalanced,       std::nullopt};
    const bool      saves = phases_.phase().name == scene_.output.bed_after;
    if (plan_.rocks && !plan_.sand && (settled || saves))
    {
        report.packing_fraction = world::packing_fraction(world_, simulation_.body_fields());
        log_.info(fmt::format("packing fraction of the rocks {:.4f}", *report.packing_fraction));
    }
    ended_.push_back(report);
    if (!saves) { return; }
    if (snapshots_) { snapshots_->finish(); }
    write_bed();
}

template<class Exec, class Real>
void Driver<Exec, Real>::write_bed()
{
    io::BedFile bed = world::make_bed(scene_, world_, simulation_.body_fields(), simulation_.contacts());
    if (plan_.sand) { bed.points = world::saved_points(communicator_, scene_, world_, simulation_.point_fields()); }
    on_root(communicator_, [&] { io::write_bed(directory_.bed(), bed, options_.provenance); });
    log_.info(fmt::format("bed of {} rocks with {} contacts and {} points of sand: {}", bed.size(),
                          bed.contacts.stiffness.size(), bed.points.volume.size(), directory_.bed()));
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void Driver<Exec, Real>::pass_on();                                                                       \
    template void Driver<Exec, Real>::begin_phase()
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
