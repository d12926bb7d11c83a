#include "run/plausibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "run/drive_room.hpp"
#include "run/wall_time.hpp"
#include "run/warnings.hpp"
#include "scene/motion_tables.hpp"
#include "world/materials.hpp"

namespace tread::run
{
namespace
{

constexpr double degrees = 180 / std::numbers::pi;

/// `value` times the power of a thousand in `factors` that brings it nearest to `usual`.
template<std::size_t n>
double meant(double value, const std::array<double, n>& factors, double usual)
{
    const auto off = [&](double factor) { return std::abs(std::log(value * factor / usual)); };
    return value *
           *std::min_element(factors.begin(), factors.end(), [&](double a, double b) { return off(a) < off(b); });
}

void check_gravity(const scene::Scene& scene, Warnings& warnings)
{
    constexpr double largest = 30; // m/s2: Jupiter has 25
    const auto&      g       = scene.domain.gravity;
    const double     size    = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    if (g[2] > 0)
    {
        warnings.add("domain", fmt::format("[domain] gravity points upwards: z = {:.4g} m/s2; z is up, so that z = "
                                           "{:.4g} seems meant",
                                           g[2], -g[2]));
    }
    if (size > largest)
    {
        const bool centimetres = size / 100 <= largest;
        warnings.add("domain", fmt::format("[domain] gravity of {:.4g} m/s2; {} seems meant (Earth has 9.81)", size,
                                           centimetres ? fmt::format("{:.4g} (given in cm/s2?)", size / 100) : "9.81"));
    }
}

/// A cohesionless bed with a slope above its friction angle slides.
void check_slope(const scene::Scene& scene, const scene::Material& soil, Warnings& warnings)
{
    const auto&  g        = scene.domain.gravity;
    const double angle    = std::atan2(std::hypot(g[0], g[1]), -g[2]) * degrees;
    const double friction = world::initial_friction_angle_deg(soil);
    if (g[2] >= 0 || soil.cohesion > 0 || friction <= 0 || angle <= friction) { return; }
    warnings.add("domain", fmt::format("[domain] gravity inclines the bed by {:.3g} degrees, more than the friction "
                                       "angle of '{}' ({:.3g} degrees): the bed slides",
                                       angle, soil.name, friction));
}

void check_density(const scene::Material& material, const std::string& table, Warnings& warnings)
{
    constexpr double least = 0.5, most = 5; // g/cm3 of soils and rocks
    if (material.density < least || material.density > most) { return; }
    warnings.add(table, fmt::format("[[material]] '{}': density = {:.4g} kg/m3; {:.4g} seems meant (given in g/cm3?)",
                                    material.name, material.density, 1000 * material.density));
}

void check_modulus(const scene::Material& soil, const std::string& table, Warnings& warnings)
{
    constexpr double least = 1e4, most = 1e9, usual = 5e6; // Pa
    if (soil.young < least)
    {
        warnings.add(table, fmt::format("[[material]] '{}': young = {:.4g} Pa is too soft for a soil; {:.4g} seems "
                                        "meant (given in kPa, MPa or GPa?)",
                                        soil.name, soil.young, meant(soil.young, std::array{1e3, 1e6, 1e9}, usual)));
    }
    if (soil.young > most)
    {
        warnings.add(table, fmt::format("[[material]] '{}': young = {:.4g} Pa is too stiff for a soil; {:.4g} seems "
                                        "meant (beds have 1e5 to 1e8 Pa, their grains more)",
                                        soil.name, soil.young, meant(soil.young, std::array{1e-3, 1e-6}, usual)));
    }
}

void check_angles(const scene::Material& soil, const std::string& table, Warnings& warnings)
{
    // No soil has a friction angle of 0.1 to 2 degrees, and dilation angles are not known to two decimals; 0 is meant.
    constexpr double least_friction = 2, least_dilation = 0.5;
    const auto       radians = [&](const char* key, double value, double least)
    {
        if (value <= 0 || value >= least) { return; }
        warnings.add(table,
                     fmt::format("[[material]] '{}': {} = {:.4g} degrees; {:.4g} seems meant (given in radians?)",
                                 soil.name, key, value, value * degrees));
    };
    radians("friction_angle_deg", soil.friction_angle_deg, least_friction);
    radians("dilation_angle_deg", soil.dilation_angle_deg, least_dilation);
    constexpr double most_cohesion = 1e6; // Pa
    if (soil.cohesion > most_cohesion)
    {
        warnings.add(table, fmt::format("[[material]] '{}': cohesion = {:.4g} Pa is a rock's; {:.4g} seems meant",
                                        soil.name, soil.cohesion, meant(soil.cohesion, std::array{1e-3, 1e-6}, 1e3)));
    }
}

void check_materials(const scene::Scene& scene, Warnings& warnings)
{
    for (const scene::Material& material : scene.materials)
    {
        const std::string table = "material." + material.name;
        check_density(material, table, warnings);
        if (!scene::is_granular(material.model)) { continue; }
        check_modulus(material, table, warnings);
        check_angles(material, table, warnings);
        check_slope(scene, material, warnings);
    }
}

void check_contacts(const scene::Scene& scene, Warnings& warnings)
{
    constexpr double most = 2;
    for (std::size_t i = 0; i < scene.contacts.size(); ++i)
    {
        const scene::Contact& contact = scene.contacts[i];
        if (contact.friction <= most) { continue; }
        const double angle = contact.friction < 60 ? contact.friction : 30;
        warnings.add(fmt::format("contact[{}]", i),
                     fmt::format("[[contact]] between {} and {}: friction = {:.4g}; {:.3g} seems meant (the tangent of "
                                 "{:.3g} degrees)",
                                 contact.between[0], contact.between[1], contact.friction, std::tan(angle / degrees),
                                 angle));
    }
}

void check_phases(const scene::Scene& scene, Warnings& warnings)
{
    constexpr double fast_lowering = 0.5; // m/s: a fall of 13 mm on Earth
    for (const scene::Phase& phase : scene.phases)
    {
        const std::string table = "phase." + phase.name;
        const auto        ramp  = [&](const char* key, double time, const char* what)
        {
            if (time <= scene::time_limit(phase)) { return; }
            warnings.add(table,
                         fmt::format("[[phase]] '{}': {}.ramp = {:.4g} s is longer than the phase ({:.4g} s): {}",
                                     phase.name, key, time, scene::time_limit(phase), what));
        };
        if (phase.drive) { ramp("drive", phase.drive->ramp, "the wheel never reaches its speed"); }
        if (phase.weight) { ramp("weight", phase.weight->ramp, "the weight never reaches its end"); }
        for (const scene::Motion& motion : phase.motion)
        {
            for (const auto& [key, course] : scene::courses_of(motion))
            {
                ramp(fmt::format("motion of '{}' {}", motion.body, key).c_str(), course.ramp,
                     "its value is never reached");
            }
        }
        if (phase.lower && phase.lower->speed > fast_lowering)
        {
            warnings.add(table,
                         fmt::format("[[phase]] '{}': lower.speed = {:.4g} m/s drops the body; {:.4g} seems meant "
                                     "(given in mm/s?)",
                                     phase.name, phase.lower->speed, 1e-3 * phase.lower->speed));
        }
    }
}

void check_step(const Estimate& wants, Warnings& warnings)
{
    constexpr double rounding = 1 + 1e-9;
    if (wants.dt <= wants.automatic * rounding) { return; }
    const bool hopeless = wants.dt > wants.hopeless;
    warnings.add("time", fmt::format("[time] dt = {:.4g} s is {:.3g} times the automatic step of {:.4g} s{}", wants.dt,
                                     wants.dt / wants.automatic, wants.automatic,
                                     hopeless ? fmt::format(": the run will stop at once, because no sand is stable "
                                                            "over {:.4g} s",
                                                            wants.hopeless)
                                              : ""));
}

void check_amount(const scene::Scene& scene, const Estimate& wants, Warnings& warnings)
{
    constexpr double most_snapshots = 1e5, most_rows = 1e7;
    const double     snapshots = scene.output.snapshots_every > 0 ? wants.time / scene.output.snapshots_every : 0;
    if (snapshots > most_snapshots)
    {
        warnings.add("output", fmt::format("[output] snapshots_every = {:.4g} s gives {:.3g} snapshots; {:.2g} would "
                                           "give a hundred",
                                           scene.output.snapshots_every, snapshots, wants.time / 100));
    }
    if (wants.time / scene.output.every > most_rows)
    {
        warnings.add("output", fmt::format("[output] every = {:.4g} s gives {:.3g} rows; {:.2g} would give a thousand",
                                           scene.output.every, wants.time / scene.output.every, wants.time / 1000));
    }
}

std::vector<Warning> drives_too_long(const scene::Scene& scene, const world::World& world,
                                     const std::vector<DriveRoom>& rooms)
{
    std::vector<Warning> found;
    for (std::string& text : drive_warnings(scene, world, rooms)) { found.push_back({{}, std::move(text)}); }
    return found;
}

} // namespace

std::string text_of(const Warning& warning)
{
    return warning.where.empty() ? warning.text : warning.where + ": " + warning.text;
}

std::vector<Warning> implausible_ground(const scene::Scene& scene)
{
    Warnings warnings(scene);
    check_gravity(scene, warnings);
    check_materials(scene, warnings);
    return warnings.take();
}

std::vector<Warning> implausible_commands(const scene::Scene& scene)
{
    Warnings warnings(scene);
    check_contacts(scene, warnings);
    check_phases(scene, warnings);
    return warnings.take();
}

std::vector<Warning> implausible_cost(const scene::Scene& scene, const world::World& world, const Estimate& wants)
{
    constexpr double most_steps = 1e9, most_wall_time = 1e4; // s, on the fastest machine that a user may have
    Warnings         warnings(scene);
    check_step(wants, warnings);
    check_amount(scene, wants, warnings);
    const solver::Plan plan   = solver::make_plan(scene, world);
    const double       on_gpu = wall_time(workload(scene, world, plan, wants, {longest_pace(wants)}), gpu_cost, 1);
    if (wants.steps > most_steps)
    {
        warnings.add("time",
                     fmt::format("the run takes {:.3g} steps of {:.3g} s for {:.4g} s: shorter phases, a longer "
                                 "dt or softer materials are meant",
                                 wants.steps, wants.resting_dt, wants.time));
    }
    if (on_gpu > most_wall_time)
    {
        warnings.add("time",
                     fmt::format("the run takes {} of wall time even on one GPU, at most, by model: fewer points "
                                 "or bodies, shorter phases or softer materials are meant",
                                 duration_text(on_gpu)));
    }
    return warnings.take();
}

std::vector<Warning> plausibility(const scene::Scene& scene, const world::World& world, const Estimate& wants,
                                  const std::vector<DriveRoom>& rooms)
{
    std::vector<Warning> all = implausible_ground(scene);
    const auto add = [&](const std::vector<Warning>& more) { all.insert(all.end(), more.begin(), more.end()); };
    if (all.empty()) { add(implausible_bodies(scene, world)); }
    add(implausible_commands(scene));
    add(drives_too_long(scene, world, rooms));
    add(implausible_cost(scene, world, wants));
    return all;
}

} // namespace tread::run
