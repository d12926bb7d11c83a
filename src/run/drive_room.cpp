#include "run/drive_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "run/phase_commands.hpp"
#include "world/body_grid.hpp"

namespace tread::run
{
namespace
{

constexpr double infinity      = std::numeric_limits<double>::infinity();
constexpr double margin_cells  = 2;
constexpr double margin_share  = 0.05; ///< margin over the body's reach
constexpr double deepest_below = 0.1;  ///< depth below the terrain's floor over the reach: walls are penetrated less
constexpr int    path_parts    = 4000; ///< intervals of a drive that are examined in turn

/// Half extents of a body that turns about its axle, m, along the axes of the world.
struct Rim
{
    double reach; ///< along x
    double half_width;
    double depth;
};

Rim rim_of(const world::World& world, std::size_t body)
{
    const auto&        form = world::template_of(world, body);
    const Vec3<double> axle = world.bodies.orientation[body] * Vec3<double>::UnitY();
    Vec3<double>       most = Vec3<double>::Zero();
    for (const Vec3<double>& vertex : form.mesh.vertices)
    {
        const double radius = std::hypot(vertex[0], vertex[2]), aside = std::abs(vertex[1]);
        for (int c = 0; c < 3; ++c)
        {
            const double across = std::sqrt(std::max(0.0, 1 - axle[c] * axle[c]));
            most[c]             = std::max(most[c], across * radius + std::abs(axle[c]) * aside);
        }
    }
    most *= world.bodies.scale[body];
    return {most[0], most[1], most[2]};
}

/// Calls visit(centre, half size) for each point of sand and each rock.
template<class Visit>
void for_each_piece(const world::World& world, Visit visit)
{
    for (const world::PointRow& row : world.sand.rows)
    {
        const double half = 0.5 * std::cbrt(world.sand.kind_of(row).volume);
        world::for_each_point(world.sand, row, [&](const world::SandPoint& point) { visit(point.position, half); });
    }
    for (auto rock = static_cast<std::size_t>(world.bodies.named); rock < world.bodies.size(); ++rock)
    {
        visit(world.bodies.position[rock], world.bodies.radius[rock]);
    }
}

/// Parts of the domain's length that have terrain within a body's width.
struct Strip
{
    double            part; ///< m
    std::vector<char> covered;

    long at(double x) const
    {
        return std::clamp(static_cast<long>(std::floor(x / part)), 0L, static_cast<long>(covered.size()) - 1);
    }

    /// Returns the far end (m) of the terrain from x on, towards high x if `step` is 1, low x if -1, ignoring gaps of
    /// up to `gap` (m); x itself if there is no terrain.
    double edge(double x, long step, double gap) const
    {
        double end = x;
        for (long i = at(x); i >= 0 && i < static_cast<long>(covered.size()); i += step)
        {
            const double near = part * static_cast<double>(i + (step > 0 ? 0 : 1));
            if (static_cast<double>(step) * (near - end) > gap) { break; }
            if (covered[static_cast<std::size_t>(i)] != 0) { end = near + static_cast<double>(step) * part; }
        }
        return end;
    }
};

std::optional<DriveRoom::Ground> ground_of(const world::World& world, const Vec3<double>& start, const Rim& rim)
{
    Strip strip{rim.reach / 16, {}};
    strip.covered.assign(static_cast<std::size_t>(std::ceil(world.geometry.size[0] / strip.part)) + 1, 0);
    DriveRoom::Ground ground{0, 0, infinity, -infinity, infinity};
    for_each_piece(world,
                   [&](const Vec3<double>& x, double half)
                   {
                       ground.low_y  = std::min(ground.low_y, x[1] - half);
                       ground.high_y = std::max(ground.high_y, x[1] + half);
                       ground.floor  = std::min(ground.floor, x[2] - half);
                       if (std::abs(x[1] - start[1]) > rim.half_width + half) { return; }
                       const auto first = strip.covered.begin() + strip.at(x[0] - half);
                       std::fill(first, strip.covered.begin() + strip.at(x[0] + half) + 1, 1);
                   });
    ground.low_x  = strip.edge(start[0], -1, rim.reach);
    ground.high_x = std::min(strip.edge(start[0], 1, rim.reach), world.geometry.size[0]);
    if (!(ground.high_x > ground.low_x)) { return {}; }
    return ground;
}

/// End of the path towards high x for direction 1, low x for -1.
WayEnd way_end(const scene::Scene& scene, const std::optional<DriveRoom::Ground>& ground, double keep, double direction)
{
    const double wall     = direction > 0 ? scene.domain.size[0] : 0;
    const bool   has_wall = scene.domain.walls.x != scene::WallKind::open;
    const double edge     = !ground ? direction * infinity : direction > 0 ? ground->high_x : ground->low_x;
    // Sand that reaches the wall has no free edge: its points lie half their spacing from it.
    const bool before = direction * (wall - edge) > (has_wall ? scene.grid.spacing : 0);
    if (ground && (before || !has_wall))
    {
        return {edge - direction * keep, fmt::format("the edge of the terrain at x = {:.4g} m", edge)};
    }
    if (has_wall) { return {wall - direction * keep, fmt::format("the wall at x = {:.4g} m", wall)}; }
    return {direction * infinity, {}};
}

DriveRoom room_of(const scene::Scene& scene, const world::World& world, std::size_t body)
{
    const Vec3<double>& start  = world.bodies.position[body];
    const Rim           rim    = rim_of(world, body);
    const auto          ground = ground_of(world, start, rim);
    const double        keep   = (1 + margin_share) * rim.reach + margin_cells * scene.grid.spacing;
    return {body,  start[0], rim.reach, rim.depth, way_end(scene, ground, keep, -1), way_end(scene, ground, keep, 1),
            ground};
}

double direction_of(const scene::Drive& drive)
{
    const double speed = drive.angular_velocity * (1 - drive.slip.value_or(0));
    return speed > 0 ? 1 : speed < 0 ? -1 : 0;
}

const WayEnd& end_ahead(const DriveRoom& room, double direction) { return direction > 0 ? room.front : room.back; }

/// Motion of the axle in a drive from x (m) on, with initial angular velocity `spin` (rad/s).
struct Path
{
    const scene::Drive& drive;
    double              radius; ///< m, rolling radius
    double              spin;
    double              x;

    double speed(double time) const
    {
        const double done = drive.ramp > 0 ? std::min(1.0, time / drive.ramp) : 1.0;
        return (1 - drive.slip.value_or(0)) * radius * (spin + done * (drive.angular_velocity - spin));
    }
};

/// Time (s) at which the path reaches `end` (m) in the direction of the drive; empty if not within `duration`. Updates
/// x to the position then.
std::optional<double> time_to(Path& path, double end, double duration)
{
    const double direction = direction_of(path.drive), step = duration / path_parts;
    for (int part = 0; part < path_parts; ++part)
    {
        if (direction * (path.x - end) >= 0) { return part * step; }
        path.x += step * path.speed((part + 0.5) * step);
    }
    return direction * (path.x - end) >= 0 ? std::optional<double>(duration) : std::nullopt;
}

/// Rounds down to three digits.
double rounded_down(double time)
{
    if (!(time > 0)) { return 0; }
    const double unit = std::pow(10, std::floor(std::log10(time)) - 2);
    return unit * std::floor(time / unit);
}

/// The nearest named body on the way from `from` to `to` (m), and the axle's position at contact.
std::optional<std::pair<std::string, double>> obstacle(const scene::Scene& scene, const world::World& world,
                                                       const DriveRoom& room, double from, double to)
{
    const double        direction = to > from ? 1 : -1, own = world::bounding_radius(world, room.body);
    const Vec3<double>& place = world.bodies.position[room.body];
    std::optional<std::pair<std::string, double>> nearest;
    for (std::size_t other = 0; other < scene.bodies.size(); ++other)
    {
        if (other == room.body) { continue; }
        const Vec3<double> off   = world.bodies.position[other] - place;
        const double       reach = world::bounding_radius(world, other);
        if (std::abs(off[1]) > own + reach || std::abs(off[2]) > own + reach) { continue; }
        const double meets = world.bodies.position[other][0] - direction * (reach + room.reach);
        if (direction * (world.bodies.position[other][0] - from) <= 0 || direction * (to - meets) <= 0) { continue; }
        if (!nearest || direction * (nearest->second - meets) > 0) { nearest = {scene.bodies[other].name, meets}; }
    }
    return nearest;
}

struct Remark
{
    const scene::Drive& drive;
    std::string         text;
};

void remark_on_body(const scene::Scene& scene, const world::World& world, const DriveRoom& room, double radius,
                    std::vector<Remark>& remarks)
{
    const std::string& name = scene.bodies[room.body].name;
    double             x = room.start, spin = 0;
    for (const scene::Phase& phase : scene.phases)
    {
        if (!phase.drive || phase.drive->body != name)
        {
            spin = 0;
            continue;
        }
        const scene::Drive& drive     = *phase.drive;
        const double        direction = direction_of(drive), from = x;
        const WayEnd&       end = end_ahead(room, direction);
        Path                path{drive, radius, spin, x};
        const auto          time = direction == 0 ? std::nullopt : time_to(path, end.axle, scene::time_limit(phase));
        x                        = time ? (direction * (from - end.axle) > 0 ? from : end.axle) : path.x;
        spin                     = drive.angular_velocity;
        if (time)
        {
            remarks.push_back(
                {drive,
                 fmt::format("phase '{}': '{}' has {:.3g} m to go before {}, and gets there after {:.3g} of "
                             "{:.4g} s{}: the phase "
                             "ends there; a duration of {:.3g} s fits",
                             phase.name, name, std::max(0.0, direction * (end.axle - from)), end.what, *time,
                             scene::time_limit(phase), drive.slip ? "" : " if it does not slip", rounded_down(*time))});
        }
        const auto other = obstacle(scene, world, room, from, x);
        if (other)
        {
            Path       until{drive, radius, path.spin, from};
            const auto meets = time_to(until, other->second, scene::time_limit(phase));
            remarks.push_back(
                {drive,
                 fmt::format("phase '{}': '{}' may meet '{}', which stands in its way, after {:.3g} m and {:.3g} s",
                             phase.name, name, other->first, std::max(0.0, direction * (other->second - from)),
                             meets.value_or(0))});
        }
    }
}

std::vector<Remark> remarks_on(const scene::Scene& scene, const world::World& world,
                               const std::vector<DriveRoom>& rooms)
{
    const std::vector<double> radii = rolling_radii(scene, world);
    std::vector<Remark>       remarks;
    for (const DriveRoom& room : rooms) { remark_on_body(scene, world, room, radii[room.body], remarks); }
    return remarks;
}

} // namespace

std::vector<DriveRoom> drive_rooms(const scene::Scene& scene, const world::World& world)
{
    std::vector<DriveRoom> rooms;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    {
        const bool driven = std::any_of(scene.phases.begin(), scene.phases.end(),
                                        [&](const scene::Phase& phase)
                                        { return phase.drive && phase.drive->body == scene.bodies[b].name; });
        if (driven) { rooms.push_back(room_of(scene, world, b)); }
    }
    return rooms;
}

double distance_to_end(const DriveRoom& room, const scene::Drive& drive, double x)
{
    const double direction = direction_of(drive);
    return direction == 0 ? infinity : direction * (end_ahead(room, direction).axle - x);
}

const WayEnd* reached_end(const DriveRoom& room, const scene::Drive& drive, double x)
{
    return distance_to_end(room, drive, x) <= 0 ? &end_ahead(room, direction_of(drive)) : nullptr;
}

std::vector<DriveWay> drive_ways(const scene::Scene& scene, const world::World& world,
                                 const std::vector<DriveRoom>& rooms)
{
    const std::vector<double> radii = rolling_radii(scene, world);
    std::vector<DriveWay>     ways;
    for (const DriveRoom& room : rooms)
    {
        double x = room.start, spin = 0;
        for (std::size_t p = 0; p < scene.phases.size(); ++p)
        {
            const auto& drive = scene.phases[p].drive;
            const bool  goes  = drive && drive->body == scene.bodies[room.body].name;
            if (goes)
            {
                Path path{*drive, radii[room.body], spin, x};
                time_to(path, drive->angular_velocity > 0 ? infinity : -infinity, scene::time_limit(scene.phases[p]));
                const double way = std::abs(path.x - x), to_end = distance_to_end(room, *drive, x);
                ways.push_back({p, way, to_end});
                x += direction_of(*drive) * std::min(way, std::max(to_end, 0.0)); // a drive ends where the range does
            }
            spin = goes ? drive->angular_velocity : 0;
        }
    }
    return ways;
}

double distance_to_leave(const DriveRoom& room, const Vec3<double>& axle)
{
    if (!room.ground) { return infinity; }
    const DriveRoom::Ground& ground = *room.ground;
    return std::min({axle[0] - ground.low_x, ground.high_x - axle[0], axle[1] - ground.low_y, ground.high_y - axle[1],
                     axle[2] - room.depth - ground.floor + deepest_below * room.depth});
}

bool has_left(const DriveRoom& room, const Vec3<double>& axle) { return distance_to_leave(room, axle) < 0; }

std::vector<std::string> drive_warnings(const scene::Scene& scene, const world::World& world,
                                        const std::vector<DriveRoom>& rooms)
{
    std::vector<std::string> warnings;
    for (const Remark& remark : remarks_on(scene, world, rooms))
    {
        if (remark.drive.slip) { warnings.push_back(remark.text); }
    }
    return warnings;
}

std::vector<std::string> drive_notes(const scene::Scene& scene, const world::World& world,
                                     const std::vector<DriveRoom>& rooms)
{
    std::vector<std::string> notes;
    for (const Remark& remark : remarks_on(scene, world, rooms))
    {
        if (!remark.drive.slip) { notes.push_back(remark.text); }
    }
    return notes;
}

} // namespace tread::run
