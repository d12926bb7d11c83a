#include "run/workload.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "run/phase_commands.hpp"
#include "run/phase_end.hpp"
#include "scene/phase_settings.hpp"
#include "solver/bodies/unchecked_span.hpp"
#include "solver/ledger/measuring.hpp"
#include "solver/pace_limits.hpp"
#include "world/footing.hpp"

namespace tread::run
{
namespace
{

/// Mean step over the bound by the compression wave where bodies touch sand: 0.67 to 1 in 94 runs of wheels, whose
/// stiffest contact limits it (docs/performance.md, "Wall time by model").
constexpr double share_in_contact = 0.85;

/// Fastest point of a turning wheel over its circumferential speed, rolling without slip.
constexpr double top_of_wheel = 2;

const world::Footing* footing_of(const std::vector<world::Footing>& footings, const scene::Scene& scene,
                                 const std::string& body)
{
    const auto at = std::find_if(footings.begin(), footings.end(),
                                 [&](const world::Footing& one) { return scene.bodies[one.body].name == body; });
    return at == footings.end() ? nullptr : &*at;
}

double settling_time(const scene::Phase& phase, const solver::Plan& plan)
{
    const double least = std::min(equilibrium_hold, phase.max_duration);
    return plan.rocks ? 0.5 * (least + phase.max_duration) : least;
}

/// On rocks, where no formula gives the sinkage, a twentieth of the radius (assumed).
double lowering_time(const scene::Phase& phase, const world::Footing* footing)
{
    if (footing == nullptr || !footing->gap) { return phase.max_duration; }
    const double sinkage = footing->patch ? footing->patch->sinkage : 0.05 * footing->radius;
    return std::min(phase.max_duration, std::max(0.0, *footing->gap + sinkage) / phase.lower->speed);
}

/// s, after which a motion with a constant velocity reaches a displacement that ends the phase; infinite without one.
double stopping_time(const scene::Motion& motion)
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; motion.until && c < motion.translation.size(); ++c)
    {
        const scene::AxisMotion& axis = motion.translation[c];
        const auto&              stop = motion.until->displacement[c];
        if (axis.kind != scene::AxisKind::velocity || axis.course.table || axis.course.value == 0 || !stop)
        {
            continue;
        }
        least = std::min(least, std::abs(*stop / axis.course.value) + 0.5 * axis.course.ramp);
    }
    return least;
}

double phase_time(const scene::Scene& scene, std::size_t p, const solver::Plan& plan,
                  const std::vector<world::Footing>& footings, const std::vector<DriveWay>& ways)
{
    const scene::Phase& phase = scene.phases[p];
    if (phase.until == scene::StopRule::equilibrium) { return settling_time(phase, plan); }
    if (phase.until == scene::StopRule::lowered)
    {
        return lowering_time(phase, footing_of(footings, scene, phase.lower->body));
    }
    double time = phase.duration;
    for (const DriveWay& way : ways)
    {
        if (way.phase == p && way.way > way.to_end)
        {
            time = std::min(time, phase.duration * std::max(0.0, way.to_end) / way.way);
        }
    }
    for (const scene::Motion& motion : phase.motion) { time = std::min(time, stopping_time(motion)); }
    return time;
}

/// m/s or rad/s, largest value of a course of velocity; 0 of any other axis.
double peak_velocity(const scene::AxisMotion& axis)
{
    if (axis.kind != scene::AxisKind::velocity) { return 0; }
    if (!axis.course.table) { return std::abs(axis.course.value); }
    double peak = 0;
    for (const double value : axis.course.table->value) { peak = std::max(peak, std::abs(value)); }
    return peak;
}

/// m/s, of the fastest point of a moved body.
double speed_of(const scene::Motion& motion, double radius)
{
    double speed = top_of_wheel * radius * peak_velocity(motion.axle);
    for (const scene::AxisMotion& axis : motion.translation) { speed = std::max(speed, peak_velocity(axis)); }
    for (const scene::AxisMotion& axis : motion.rotation) { speed = std::max(speed, radius * peak_velocity(axis)); }
    return speed;
}

/// m/s, of the fastest point of the bodies that a phase moves; `motors`: m/s, of wheels that motors turn.
double commanded_speed(const scene::Scene& scene, const scene::Phase& phase, const std::vector<double>& radii,
                       double motors)
{
    const auto radius = [&](const std::string& body)
    {
        const auto at = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                     [&](const scene::Body& one) { return one.name == body; });
        return radii[static_cast<std::size_t>(at - scene.bodies.begin())];
    };
    double speed = motors;
    if (phase.lower) { speed = std::max(speed, phase.lower->speed); }
    if (phase.drive)
    {
        speed = std::max(speed, top_of_wheel * std::abs(phase.drive->angular_velocity) * radius(phase.drive->body));
    }
    for (const scene::Motion& motion : phase.motion) { speed = std::max(speed, speed_of(motion, radius(motion.body))); }
    return speed;
}

/// Box around a body in world axes at the start, m.
Eigen::AlignedBox3d box_of(const world::World& world, std::size_t b)
{
    const shape::Bounds&  box    = world::template_of(world, b).box;
    const double          scale  = world.bodies.scale[b];
    const Eigen::Matrix3d turn   = world.bodies.orientation[b].toRotationMatrix();
    const Eigen::Vector3d centre = world.bodies.position[b] + scale * (turn * (0.5 * (box.low + box.high)));
    const Eigen::Vector3d half   = 0.5 * scale * (turn.cwiseAbs() * box.extent());
    return {centre - half, centre + half};
}

/// Whether a named body lies so near to another at the start that they will touch. Joined bodies overlap and do not.
bool meets_another(const world::World& world, std::size_t b)
{
    constexpr double near = 0.05; // radii
    if (!world.joints.empty()) { return false; }
    for (std::size_t other = 0; other < static_cast<std::size_t>(world.bodies.named); ++other)
    {
        const double margin = near * std::min(world.bodies.radius[b], world.bodies.radius[other]);
        if (other != b && box_of(world, b).exteriorDistance(box_of(world, other)) < margin) { return true; }
    }
    return false;
}

/// s, least sqrt(m / sum K) in the scene: of rocks, or of named bodies that lie on the ground or on each other. Those
/// have about one contact, rocks in a pile some four, which halves the time.
double shortest_contact(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                        const Estimate& wants)
{
    constexpr double one_contact = 2;
    if (plan.rocks || !plan.body_contact) { return wants.resting_contact; }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        if (plan.sand && !meets_another(world, b)) { continue; }
        least = std::min(least, one_contact * resting_contact(scene, world, b));
    }
    return std::isfinite(least) ? least : 0;
}

/// `touches`: whether bodies touch sand.
solver::TimeStep expected_step(const scene::TimeOptions& options, const solver::PaceLimits& limits,
                               const solver::Pace& pace, bool touches)
{
    solver::TimeStep step = solver::choose_step(options, limits, pace, 0);
    if (!touches || options.dt) { return step; }
    step.dt       = std::min(step.dt, share_in_contact * limits.courant * limits.spacing / limits.wave_speed);
    step.substeps = solver::substeps_of(options, step.dt, limits, pace);
    return step;
}

/// Searches a step, where bodies and sand move at most at `pace.largest_speed`.
double searches_a_step(const solver::TimeStep& step, const solver::PaceLimits& limits, const solver::Pace& pace,
                       const solver::Plan& plan)
{
    if (!plan.sand || plan.rocks) { return 1; }
    auto every = static_cast<double>(solver::Measuring::most_steps);
    if (pace.largest_speed > 0)
    {
        every = static_cast<double>(solver::steps_until_measured(step, limits, pace, limits.spacing));
    }
    if (plan.body_contact)
    {
        const solver::MotionBound motion{pace.largest_speed, limits.gravity};
        every = std::min(every, std::floor(solver::unchecked_span(limits.smallest_body, motion) / step.dt));
    }
    return 1 / std::max(1.0, every);
}

/// Points in a layer one point thick on rocks; those next to wheels are few.
double points_near_rocks(const world::World& world, const solver::Plan& plan)
{
    if (!plan.coupling) { return 0; }
    double area = 0; // m2
    for (auto b = static_cast<std::size_t>(world.bodies.named); b < world.bodies.size(); ++b)
    {
        const shape::SurfaceNodes& nodes = world::template_of(world, b).nodes;
        const double               side  = nodes.spacing * world.bodies.scale[b];
        area += side * side * static_cast<double>(nodes.positions.size());
    }
    return std::min(area / (world.point_spacing * world.point_spacing), static_cast<double>(world.sand.size()));
}

} // namespace

std::vector<PhasePace> expected_phases(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                                       const Estimate& wants, const std::vector<DriveRoom>& rooms)
{
    const solver::PaceLimits          limits   = solver::pace_limits(scene, world, plan);
    const std::vector<world::Footing> footings = world::footings(scene, world);
    const std::vector<DriveWay>       ways     = drive_ways(scene, world, rooms);
    const std::vector<double>         radii    = rolling_radii(scene, world);
    const double                      contact  = shortest_contact(scene, world, plan, wants);
    const double                      widest   = radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
    double                            motors   = 0;
    std::vector<PhasePace>            phases;
    phases.reserve(scene.phases.size());
    for (std::size_t p = 0; p < scene.phases.size(); ++p)
    {
        const scene::Phase& phase = scene.phases[p];
        for (const auto& motor : phase.motors)
        {
            motors = std::max(motors, top_of_wheel * std::abs(motor.speed) * widest);
        }
        solver::Pace pace;
        pace.largest_speed             = commanded_speed(scene, phase, radii, motors);
        pace.shortest_contact          = (plan.rocks ? std::sqrt(scene::mass_scaling_in(scene, p)) : 1) * contact;
        const bool             touches = plan.coupling && phase.until != scene::StopRule::equilibrium;
        const solver::TimeStep step    = expected_step(scene.time, limits, pace, touches);
        phases.push_back({phase_time(scene, p, plan, footings, ways), step.dt, static_cast<double>(step.substeps),
                          searches_a_step(step, limits, pace, plan)});
    }
    return phases;
}

Workload workload(const scene::Scene& scene, const world::World& world, const solver::Plan& plan, const Estimate& wants,
                  const std::vector<PhasePace>& phases)
{
    const auto   points = static_cast<double>(world.sand.size()), bodies = static_cast<double>(world.bodies.size());
    const double near = points_near_rocks(world, plan);
    Workload     work{};
    for (const PhasePace& phase : phases)
    {
        const double steps    = std::ceil(phase.time / phase.dt);
        const double substeps = plan.bodies ? steps * phase.substeps : 0;
        work.sand_steps += plan.sand ? steps : 0;
        work.searches += steps * phase.searches;
        work.substeps += substeps;
        work.joint_substeps += world.joints.empty() ? 0 : substeps;
        work.rows += phase.time / scene.output.every * static_cast<double>(1 + world.bodies.named);
        work.points += steps * points;
        work.yielding_points += plan.plasticity ? steps * points : 0;
        work.pages += steps * wants.node_pages;
        work.bodies += steps * phase.searches * bodies;
        work.body_substeps += substeps * bodies;
        work.near_substeps += substeps * near;
    }
    return work;
}

} // namespace tread::run
