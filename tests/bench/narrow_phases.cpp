#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/random.hpp"
#include "unit/kernels/dem_ray_shapes.hpp"

// Prints the table of docs/rays.md as CSV: two dented rocks meet off their centres, turned in several ways, without
// friction and damping; by distance fields of several grids and by rays, for several counts of surface nodes.
namespace
{

using namespace tread;
using namespace tread::test;

using Scene = SolidScene<Cpu>;

constexpr int    turns = 6;
constexpr double dt = 4e-6, contact_time = 0.04;

/// The two rocks of a turn just before they touch.
std::vector<Solid> about_to_touch(const SolidShape& solid, std::vector<Solid> rocks)
{
    constexpr double stride = 1e-4; // s: a tenth of a millimetre
    Scene            scene(Cpu{}, {solid}, rocks, {});
    while (scene.bodies.force.to_host()[0].norm() == 0)
    {
        for (Solid& rock : rocks) { rock.position += stride * rock.velocity; }
        scene.run(stride, 1, 1);
    }
    for (Solid& rock : rocks) { rock.position -= 2 * stride * rock.velocity; }
    return rocks;
}

std::vector<std::vector<Solid>> starts(const shape::ShapeTemplate& form)
{
    std::vector<std::vector<Solid>> found;
    Random                          random(7);
    for (int turn = 0; turn < turns; ++turn)
    {
        found.push_back(about_to_touch(solid_of(form), off_centre_rocks(form, random)));
    }
    return found;
}

struct Result
{
    std::vector<double>       force;      ///< N, largest, of each turn
    std::vector<Vec3<double>> velocity;   ///< m/s, of the first rock after the impact
    double                    energy = 0; ///< rms of the relative change
    double                    worst  = 0;
    double                    cost   = 0; ///< s, of a substep's contacts, the rocks in each other
};

/// s, of the contacts of one substep, at the places where the force is large.
double cost_of(Scene& scene)
{
    constexpr int repeats = 200;
    const auto    before  = std::chrono::steady_clock::now();
    for (int repeat = 0; repeat < repeats; ++repeat) { scene.contact(dt); }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count() / repeats;
}

Result measure(const shape::ShapeTemplate& form, const dem::RayView* rays, const std::vector<std::vector<Solid>>& all)
{
    const SolidShape solid = solid_of(form);
    Result           result;
    for (const std::vector<Solid>& rocks : all)
    {
        Scene scene(Cpu{}, {solid}, rocks, {});
        scene.rays                 = rays;
        const dem::BodySums before = scene.sums();
        double              force = 0, cost = 0;
        for (int block = 0; block < static_cast<int>(contact_time / dt) / 20; ++block)
        {
            scene.run(dt, 20);
            const double now = scene.bodies.force.to_host()[0].norm();
            if (now > force && block % 10 == 0) { cost = cost_of(scene); }
            force = std::max(force, now);
        }
        const dem::BodySums after  = scene.sums();
        const double        change = (after.kinetic + after.contact) / before.kinetic - 1;
        result.force.push_back(force);
        result.velocity.push_back(scene.bodies.velocity.to_host()[0]);
        result.energy += change * change / turns;
        result.worst = std::max(result.worst, std::abs(change));
        result.cost += cost / turns;
    }
    result.energy = std::sqrt(result.energy);
    return result;
}

void print(const char* phase, int nodes, int cells, const Result& result, const Result& reference)
{
    double force = 0, velocity = 0, mean = 0;
    for (std::size_t turn = 0; turn < result.force.size(); ++turn)
    {
        const double off = result.force[turn] / reference.force[turn] - 1;
        force += off * off / turns;
        velocity += (result.velocity[turn] - reference.velocity[turn]).squaredNorm() / turns;
        mean += result.force[turn] / turns;
    }
    std::printf("%s,%d,%d,%.2f,%.1e,%.1e,%.4f,%.4f,%.1f\n", phase, nodes, cells, 1e6 * result.cost, result.energy,
                result.worst, std::sqrt(force), std::sqrt(velocity), mean);
    std::fflush(stdout);
}

} // namespace

int main()
{
    const shape::ShapeTemplate finest    = dented_rock(2562, 128);
    const auto                 all       = starts(finest);
    const Result               reference = measure(finest, nullptr, all);
    std::printf("narrow_phase,nodes,sdf_cells,contact_us,energy_rms,energy_worst,force_off,velocity_off,mean_force\n");
    for (const int nodes : {42, 162, 642, 2562})
    {
        for (const int cells : {32, 64, 128})
        {
            print("sdf", nodes, cells, measure(dented_rock(nodes, cells), nullptr, all), reference);
        }
        const shape::ShapeTemplate form = dented_rock(nodes, 32);
        const Rays<Cpu>            rays(Cpu{}, rays_of(form.mesh, form.nodes.positions));
        print("rays", nodes, 32, measure(form, rays.views(), all), reference);
    }
    return 0;
}
