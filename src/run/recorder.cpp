#include "run/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "run/motions.hpp"
#include "run/phase_commands.hpp"
#include "scene/phase_settings.hpp"

namespace tread::run
{
namespace
{

void append(std::vector<double>& row, const Vec3<double>& value)
{
    row.insert(row.end(), value.data(), value.data() + 3);
}

std::vector<io::Column> wheel_columns()
{
    return {{"time", 1, "s"},         {"position", 3, "m"}, {"velocity", 3, "m/s"}, {"angular_velocity", 3, "rad/s"},
            {"force", 3, "N"},        {"torque", 3, "N m"}, {"sinkage", 1, "m"},    {"slip", 1, "1"},
            {"drawbar_pull", 1, "N"}, {"power", 1, "W"}};
}

std::vector<io::Column> energy_columns(const scene::Scene& scene)
{
    std::vector<io::Column> columns = {{"time", 1, "s"}};
    for (const char* name : {"kinetic_points", "strain", "kinetic_bodies", "contact", "gravity", "half_step", "plastic",
                             "friction", "restitution", "damping", "transfer", "coupling", "work_in", "total"})
    {
        columns.push_back({name, 1, "J"});
    }
    if (scene::scales_inertia(scene)) { columns.push_back({"mass_scaling", 1, "J"}); }
    return columns;
}

/// Whether a phase prescribes a motion of the body.
bool is_moved(const scene::Scene& scene, const scene::Body& body)
{
    return std::any_of(scene.phases.begin(), scene.phases.end(),
                       [&](const scene::Phase& phase) { return scene::motion_of(phase, body.name) != nullptr; });
}

std::vector<io::Column> columns_of(const scene::Scene& scene, const scene::Body& body)
{
    std::vector<io::Column> columns = wheel_columns();
    if (is_moved(scene, body))
    {
        columns.push_back({"reaction_force", 3, "N"});
        columns.push_back({"reaction_torque", 3, "N m"});
    }
    return columns;
}

std::vector<io::Column> joint_columns()
{
    return {{"time", 1, "s"},
            {"force", 3, "N"},
            {"torque", 3, "N m"},
            {"motor_torque", 1, "N m"},
            {"coordinate", 1, "m or rad"},
            {"gap", 1, "m"},
            {"misalignment", 1, "rad"},
            {"excess", 1, "m or rad"}};
}

std::string group(const scene::Joint& joint) { return "/joint/" + joint.name; }
std::string group(const scene::Body& body) { return "/wheel/" + body.name; }

} // namespace

std::vector<io::SeriesTable> series_tables(const scene::Scene& scene, int ranks)
{
    std::vector<io::SeriesTable> tables;
    for (const scene::Body& body : scene.bodies) { tables.push_back({group(body), columns_of(scene, body)}); }
    for (const scene::Joint& joint : scene.joints) { tables.push_back({group(joint), joint_columns()}); }
    tables.push_back({"/energy", energy_columns(scene)});
    tables.push_back(
        {"/balance", {{"time", 1, "s"}, {"mass", 1, "kg"}, {"momentum", 3, "kg m/s"}, {"impulse_error", 1, "1"}}});
    tables.push_back({"/phases", {{"index", 1, "1"}, {"start", 1, "s"}}});
    if (ranks == 1) { return tables; }
    tables.push_back(
        {"/ranks", {{"time", 1, "s"}, {"imbalance", 1, "1"}, {"repartitions", 1, "1"}, {"points_moved", 1, "1"}}});
    return tables;
}

Recorder::Recorder(const io::RunDirectory& directory, const scene::Scene& scene, const world::World& world, int ranks,
                   const io::Provenance& provenance, io::SeriesFile file)
    : scene_(scene)
    , rolling_radii_(rolling_radii(scene, world))
    , series_(directory.time_series(), provenance, file)
{
    for (const io::SeriesTable& table : series_tables(scene, ranks)) { series_.add_table(table); }
}

void Recorder::begin_phase(std::size_t index, double time)
{
    series_.append("/phases", {static_cast<double>(index), time});
}

void Recorder::write_ranks(double time, const decomp::BalanceRow& balance)
{
    series_.append("/ranks", {time, balance.imbalance, static_cast<double>(balance.repartitions),
                              static_cast<double>(balance.points_moved)});
}

void Recorder::write_joints(double time, const std::vector<solver::JointRow>& joints)
{
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        const solver::JointRow& joint = joints[j];
        std::vector<double>     row   = {time};
        append(row, joint.force);
        append(row, joint.torque);
        row.insert(row.end(), {joint.motor_torque, joint.coordinate, joint.gap, joint.misalignment, joint.excess});
        series_.append(group(scene_.joints[j]), row);
    }
}

void Recorder::write(double time, const std::vector<solver::BodyRow>& bodies, const solver::EnergyRow& energy,
                     const solver::BalanceRow& balance)
{
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const solver::BodyRow& body = bodies[b];
        const double           rim  = spin_of(body) * rolling_radii_[b];
        const double           slip =
            std::abs(rim) > 1e-9 ? 1 - body.velocity[0] / rim : std::numeric_limits<double>::quiet_NaN();
        std::vector<double> row = {time};
        append(row, body.position);
        append(row, body.velocity);
        append(row, body.angular_velocity);
        append(row, body.force);
        append(row, body.torque);
        for (const double value : {body.surface - body.lowest, slip, body.force[0], body.power})
        {
            row.push_back(value);
        }
        if (is_moved(scene_, scene_.bodies[b]))
        {
            append(row, body.reaction_force);
            append(row, body.reaction_torque);
        }
        series_.append(group(scene_.bodies[b]), row);
    }
    std::vector<double> parts = {
        time,           energy.kinetic_points, energy.strain,   energy.kinetic_bodies, energy.contact,
        energy.gravity, energy.half_step,      energy.plastic,  energy.friction,       energy.restitution,
        energy.damping, energy.transfer,       energy.coupling, energy.work_in,        energy.total};
    if (scene::scales_inertia(scene_)) { parts.push_back(energy.mass_scaling); }
    series_.append("/energy", parts);
    std::vector<double> row = {time, balance.mass};
    append(row, balance.momentum);
    row.push_back(balance.impulse_error);
    series_.append("/balance", row);
}

} // namespace tread::run
