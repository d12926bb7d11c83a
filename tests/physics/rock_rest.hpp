#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "rock_scenes.hpp"

// Rocks left alone: tests that they come to rest.
namespace tread::test
{

inline constexpr double rock_radius = 5e-3; ///< m, of the sphere of equal volume

/// Bumpy rocks of 162 nodes, rounded cubes and cubes, each of the volume of a sphere of 1 m, as shapes of a scene.
class RockForms
{
public:
    RockForms()
        : rounded_(rounded_cube_mesh())
        , cube_(box_mesh(Vec3<double>::Constant(0.5)))
    {
    }

    std::string text() const
    {
        return R"(
[[shape]]
name = "bumpy"
generate = { kind = "rock", seed = 5, nodes = 162 }
sdf_cells = 40
)" + file_shape("rounded", rounded_, 0.37, 32) +
               file_shape("cube", cube_, 0.2, 32);
    }

private:
    MeshFile rounded_, cube_;
};

inline std::string rocks_of(const std::string& kind, int count, const std::string& placement, const Vec3<double>& low,
                            const Vec3<double>& high)
{
    return fmt::format(R"(
[[rocks]]
shape = "{}"
material = "stone"
count = {}
diameter = {}
placement = "{}"
region = {{ box = [[{}, {}, {}], [{}, {}, {}]] }}
)",
                       kind, count, 2 * rock_radius, placement, low[0], low[1], low[2], high[0], high[1], high[2]);
}

/// Positions (m) and angular velocities (rad/s) of all rocks.
struct RockStates
{
    std::vector<double> position, spin;
};

template<class Experiment>
RockStates states(Experiment& experiment)
{
    const io::BodyFields fields = experiment.simulation().body_fields();
    return {fields.position, fields.angular_velocity};
}

/// Runs a scene whose last phase leaves the rocks undisturbed after `damped` (s), for `free` (s). Checks the targets of
/// the issue: kinetic energy per rock of at most 1e-8 m g R after half of the free time, displacement at most 1e-2 R in
/// 2 s (scaled by `free`), no spin, and energy that does not rise.
template<class Exec>
void expect_rest(const Exec& exec, const std::string& text, double damped, double free)
{
    Experiment<Exec> run(exec, text);
    RockStates       start;
    double           most_kinetic = 0, energy_start = 0, energy_most = -1e300;
    int              steps = 0;
    run.run(
        [&](double time)
        {
            if (time < damped) { return; }
            if (start.position.empty())
            {
                start                         = states(run);
                const solver::RigidCensus now = run.simulation().census().rigid;
                energy_start = energy_most = now.kinetic + now.contact + now.gravity;
            }
            if (steps++ % 20 != 0) { return; }
            const solver::RigidCensus now = run.simulation().census().rigid;
            energy_most                   = std::max(energy_most, now.kinetic + now.contact + now.gravity);
            if (time > damped + 0.5 * free) { most_kinetic = std::max(most_kinetic, now.kinetic); }
        });
    const RockStates end  = states(run);
    const double     unit = run.simulation().census().rigid.mass * earth * rock_radius;
    double           way = 0, spin = 0;
    for (std::size_t i = 0; i < end.position.size(); i += 3)
    {
        const Vec3<double> moved(end.position[i] - start.position[i], end.position[i + 1] - start.position[i + 1],
                                 end.position[i + 2] - start.position[i + 2]);
        way  = std::max(way, moved.norm() / rock_radius);
        spin = std::max(spin, Vec3<double>(end.spin[i], end.spin[i + 1], end.spin[i + 2]).norm());
    }
    const double longest = 1e-2 * free / 2, rise = (energy_most - energy_start) / unit;
    report("kinetic energy over N m g R", most_kinetic / unit, 0, 1e-8, "docs/verification.md#rocks-at-rest");
    report("longest way over R", way, 0, longest, fmt::format("1e-2 in 2 s, here {} s", free));
    report("largest spin in rad/s", spin, 0, 1e-2,
           "turns by 1e-2 R in a second; docs/verification.md#rocks-at-rest left 0.03 to 5");
    report("rise of the energy over N m g R", rise, 0, 1e-8, "no more than the kinetic energy at rest");
    EXPECT_LT(most_kinetic / unit, 1e-8);
    EXPECT_LT(way, longest);
    EXPECT_LT(spin, 1e-2);
    EXPECT_LT(rise, 1e-8);
}

} // namespace tread::test
