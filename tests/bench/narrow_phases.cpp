#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <vector>

#include "base/random.hpp"
#include "unit/kernels/dem_ray_shapes.hpp"

// Prints docs/studies/narrow_phases.csv: off-centre impacts of two dented rocks in several orientations, without
// friction and damping; with distance fields of several grids and with rays, for several numbers of surface nodes.
namespace
{

using namespace tread;
using namespace tread::test;

using Scene = SolidScene<Cpu>;

constexpr int    turns = 12, repeats = 3;
constexpr double dt = 1e-5, duration = 0.04;
constexpr int    block = 20; ///< substeps between pair searches

/// The two rocks of one orientation just before they touch.
std::vector<Solid> about_to_touch(const Cpu& cpu, const SolidShape& solid, std::vector<Solid> rocks)
{
    constexpr double stride = 1e-4; // s: a tenth of a millimetre
    Scene            scene(cpu, {solid}, rocks, {});
    while (scene.bodies.force.to_host()[0].norm() == 0)
    {
        for (Solid& rock : rocks) { rock.position += stride * rock.velocity; }
        scene.run(stride, 1, 1);
    }
    for (Solid& rock : rocks) { rock.position -= 2 * stride * rock.velocity; }
    return rocks;
}

std::vector<std::vector<Solid>> starts(const Cpu& cpu, const shape::ShapeTemplate& form)
{
    std::vector<std::vector<Solid>> found;
    Random                          random(7);
    found.reserve(turns);
    for (int turn = 0; turn < turns; ++turn)
    {
        found.push_back(about_to_touch(cpu, solid_of(form), off_centre_rocks(form, random)));
    }
    return found;
}

struct Outcome
{
    double       energy;   ///< relative change
    double       force;    ///< N, largest
    Vec3<double> velocity; ///< m/s, of the first rock afterwards
    double       time;     ///< s of processor time, for all substeps
};

Outcome impact(const Cpu& cpu, const SolidShape& solid, const dem::RayView* rays, const std::vector<Solid>& rocks)
{
    Scene scene(cpu, {solid}, rocks, {});
    scene.rays                 = rays;
    const dem::BodySums before = scene.sums();
    Outcome             found{};
    for (int done = 0; done < static_cast<int>(duration / dt); done += block)
    {
        const std::clock_t start = std::clock();
        scene.run(dt, block, block);
        found.time += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        found.force = std::max(found.force, scene.bodies.force.to_host()[0].norm());
    }
    const dem::BodySums after = scene.sums();
    found.energy              = (after.kinetic + after.contact) / before.kinetic - 1;
    found.velocity            = scene.bodies.velocity.to_host()[0];
    return found;
}

/// Impacts in all orientations; the time of each is the shortest of its repeats.
std::vector<Outcome> impacts(const Cpu& cpu, const shape::ShapeTemplate& form, const dem::RayView* rays,
                             const std::vector<std::vector<Solid>>& all)
{
    const SolidShape     solid = solid_of(form);
    std::vector<Outcome> found;
    for (const std::vector<Solid>& rocks : all)
    {
        Outcome best{};
        best.time = std::numeric_limits<double>::max();
        for (int repeat = 0; repeat < repeats; ++repeat)
        {
            const Outcome next = impact(cpu, solid, rays, rocks);
            if (next.time < best.time) { best = next; }
        }
        found.push_back(best);
    }
    return found;
}

void print(const char* phase, int nodes, int cells, const std::vector<Outcome>& found,
           const std::vector<Outcome>& reference)
{
    double              time = 0, square = 0, force = 0, velocity = 0, mean = 0;
    std::vector<double> changes;
    for (std::size_t turn = 0; turn < found.size(); ++turn)
    {
        const double off = found[turn].force / reference[turn].force - 1;
        time += found[turn].time / turns;
        square += found[turn].energy * found[turn].energy / turns;
        force += off * off / turns;
        velocity += (found[turn].velocity - reference[turn].velocity).squaredNorm() / turns;
        mean += found[turn].force / turns;
        changes.push_back(std::abs(found[turn].energy));
    }
    std::sort(changes.begin(), changes.end());
    std::printf("%s,%d,%d,%.3f,%.2e,%.2e,%.2e,%.4f,%.4f,%.1f\n", phase, nodes, cells, 1e3 * time,
                0.5 * (changes[turns / 2 - 1] + changes[turns / 2]), std::sqrt(square), changes.back(),
                std::sqrt(force), std::sqrt(velocity), mean);
    std::fflush(stdout);
}

} // namespace

int main()
{
    Counters                   counters;
    const Cpu                  cpu{&counters};
    const shape::ShapeTemplate finest    = dented_rock(10242, 128);
    const auto                 all       = starts(cpu, finest);
    const auto                 reference = impacts(cpu, finest, nullptr, all);
    std::printf("narrow_phase,nodes,sdf_cells,cpu_ms,energy_median,energy_rms,energy_worst,force_off,velocity_off_m_s,"
                "mean_force_N\n");
    for (const int nodes : {42, 162, 642, 2562})
    {
        for (const int cells : {32, 64, 128})
        {
            print("sdf", nodes, cells, impacts(cpu, dented_rock(nodes, cells), nullptr, all), reference);
        }
        const shape::ShapeTemplate form = dented_rock(nodes, 64); // the grid selects the nodes
        const Rays<Cpu>            rays(cpu, rays_of(form.mesh, form.nodes.positions));
        print("rays", nodes, 64, impacts(cpu, form, rays.views(), all), reference);
    }
    return 0;
}
