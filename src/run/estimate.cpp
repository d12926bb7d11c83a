#include "run/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "base/bytes_text.hpp"
#include "base/errors.hpp"
#include "base/saturated.hpp"
#include "kernels/dem/contact/ray_kern.hpp"
#include "kernels/dem/sleep/sleeping_bodies.hpp"
#include "kernels/mpm/grid/wall_kern.hpp"
#include "kernels/mpm/pages/census.hpp"
#include "kernels/mpm/pages/moves.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/transfers/gather.hpp"
#include "scene/phase_settings.hpp"
#include "solver/coupling/sand_body_coupling.hpp"
#include "solver/ledger/sand_guard.hpp"
#include "solver/pace_limits.hpp"

namespace tread::run
{
namespace
{

using mpm::Index3;

std::int64_t bytes_of_real(const scene::Scene& scene)
{
    return scene.numerics.precision == scene::Precision::single_ ? 4 : 8;
}

/// Bytes of a point's fields (kernels/mpm/points.hpp).
std::int64_t field_bytes(const scene::Scene& scene, const solver::Plan& plan)
{
    const std::int64_t real   = bytes_of_real(scene);
    std::int64_t       fields = 2 * 3 * 8 + (3 + 6 + 3) * real + 4 + 1;
    if (plan.affine) { fields += 9 * real; }
    if (plan.plasticity) { fields += 3 * real; }
    if (plan.cap) { fields += real; }
    if (plan.nonlocal) { fields += real; }
    if (plan.coupling) { fields += 9 * real; }
    if (scene.numerics.volume_strain == scene::VolumeStrain::cell_average) { fields += 6 * real; }
    return fields;
}

/// Bytes of a point: fields, place in the lists, and share of the sort's scratch memory.
std::int64_t bytes_per_point(const scene::Scene& scene, const solver::Plan& plan)
{
    constexpr std::int64_t lists = 4 + 1 + 2, keys = 8 + 4, sort = 16;
    return field_bytes(scene, plan) + lists + keys + sort;
}

/// Extra bytes of a point when all fall asleep at one check (solver/sand/sand_sleep.cpp): a place among the sleeping
/// points, which have an eighth to spare, the packed row that moves it there, and the list of moved points.
std::int64_t sleep_bytes_per_point(const scene::Scene& scene, const solver::Plan& plan)
{
    constexpr std::int64_t list   = 4 + 4 + 8 + 4;
    const std::int64_t     fields = field_bytes(scene, plan);
    return plan.sleep ? fields + fields / 8 + fields + list : 0;
}

struct PageCounts
{
    std::int64_t holding; ///< pages that hold points
    std::int64_t points;  ///< point pages: those, and neighbours within reach
    std::int64_t nodes;
    std::int64_t walls; ///< node pages with nodes that walls may hold
};

/// Adds the pages within a cell's reach, as order_points lists them: along each axis its own and the one beyond the
/// nearer face.
template<class Add>
void add_reached(mpm::Index3 cell, const mpm::GridGeometry& geometry, const Add& add)
{
    const auto   nearer  = [](std::int32_t at) { return (at & 3) < mpm::page_edge / 2 ? -1 : 1; };
    const Index3 page    = mpm::page_of(cell);
    const auto   lattice = mpm::level_lattice(geometry.lattice(), mpm::level_of(page));
    const double edge = mpm::page_edge * lattice.spacing, shift = lattice.node_shift * lattice.spacing;
    for (int corner = 0; corner < 8; ++corner)
    {
        const Index3 reached{page.x + (corner & 1) * nearer(cell.x), page.y + (corner >> 1 & 1) * nearer(cell.y),
                             page.z + (corner >> 2) * nearer(cell.z)};
        const double corner_at[] = {reached.x * edge + shift, reached.y * edge + shift, reached.z * edge + shift};
        const double margin      = 3 * geometry.spacing;
        bool         kept        = true;
        for (int c = 0; c < 3; ++c)
        {
            kept = kept && corner_at[c] + edge >= -margin && (c == 2 || corner_at[c] <= geometry.size[c] + margin);
        }
        if (kept || corner == 0) { add(mpm::page_key(reached)); }
    }
}

/// Octants of the pages that hold points, as bits: the pages within reach of a cell depend on its octant.
std::unordered_map<std::uint64_t, std::uint8_t> octants_of_pages(const world::World& world)
{
    constexpr std::int32_t                          nowhere = std::numeric_limits<std::int32_t>::min();
    std::unordered_map<std::uint64_t, std::uint8_t> octants;
    Index3                                          last{nowhere, nowhere, nowhere};
    const mpm::Lattice                              lattice = world.geometry.lattice();
    const auto                                      add     = [&](const world::SandPoint& point)
    {
        const Index3 cell = mpm::finest_cell(lattice, world.geometry.refinement, point.position);
        const Index3 half{cell.x >> 1, cell.y >> 1, cell.z >> 1}; // consecutive points are often in one octant
        if (half.x == last.x && half.y == last.y && half.z == last.z) { return; }
        last             = half;
        const int octant = (half.x & 1) | (half.y & 1) << 1 | (half.z & 1) << 2;
        octants[mpm::page_key(mpm::page_of(cell))] |= static_cast<std::uint8_t>(1 << octant);
    };
    world::for_each_point(world.sand, add);
    return octants;
}

/// Pages within reach of the points.
std::unordered_set<std::uint64_t> reached_pages(const world::World&                                    world,
                                                const std::unordered_map<std::uint64_t, std::uint8_t>& octants)
{
    constexpr std::int32_t            half = mpm::page_edge / 2;
    std::unordered_set<std::uint64_t> reached;
    for (const auto& [key, held] : octants)
    {
        const Index3 low = mpm::node_at(mpm::page_coordinates(key), 0);
        for (int octant = 0; octant < 8; ++octant)
        {
            if ((held >> octant & 1) == 0) { continue; }
            const Index3 cell{low.x + half * (octant & 1), low.y + half * (octant >> 1 & 1),
                              low.z + half * (octant >> 2)};
            add_reached(cell, world.geometry, [&](std::uint64_t page) { reached.insert(page); });
        }
    }
    return reached;
}

PageCounts count_pages(const world::World& world)
{
    const auto                              holding = octants_of_pages(world);
    const std::unordered_set<std::uint64_t> points  = reached_pages(world, holding);
    std::unordered_set<std::uint64_t>       nodes;
    for (const std::uint64_t key : points)
    {
        const Index3 page = mpm::page_coordinates(key);
        for (int octant = 0; octant < 8; ++octant)
        {
            nodes.insert(mpm::page_key({page.x + (octant & 1), page.y + (octant >> 1 & 1), page.z + (octant >> 2)}));
        }
    }
    const auto held = [&](std::uint64_t key)
    { return mpm::has_held_nodes(world.grid_walls, mpm::page_coordinates(key)); };
    return {static_cast<std::int64_t>(holding.size()), static_cast<std::int64_t>(points.size()),
            static_cast<std::int64_t>(nodes.size()), std::count_if(nodes.begin(), nodes.end(), held)};
}

/// Bytes of tiles, lists and sums of the pages (kernels/mpm/pages/pages.hpp, solver/sand/mpm_solver.cpp), and of their
/// keys.
std::int64_t page_bytes(const scene::Scene& scene, const solver::Plan& plan, const PageCounts& pages)
{
    const std::int64_t real       = bytes_of_real(scene);
    const bool         means      = scene.numerics.volume_strain == scene::VolumeStrain::cell_average;
    const std::int64_t point_page = mpm::node_channels * mpm::tile_nodes * real + (means ? mpm::page_cells * real : 0) +
                                    (plan.nonlocal ? 3 * mpm::page_cells * real : 0) + 2 * 4 * (mpm::page_cells + 1) +
                                    8 + 4 * (mpm::directions + mpm::move_counts + 8) +
                                    8 * (std::int64_t{mpm::tally_width(mpm::point_sums)} +
                                         std::int64_t{mpm::point_peaks} + std::int64_t{mpm::census_count});
    const std::int64_t node_page = mpm::motion_channels * mpm::page_cells * real +
                                   8 * (std::int64_t{mpm::tally_width(mpm::grid_sums)} + 1) + 4 * 8 + 4;
    const std::int64_t wall_page = 4 * (1 + mpm::directions) + 4 * mpm::page_cells * real;
    const std::int64_t found     = std::max(mpm::directions * pages.holding, 8 * pages.points);
    return pages.points * point_page + pages.nodes * node_page + pages.walls * wall_page + found * (8 + 4);
}

/// Bytes of a point in a snapshot (io/snapshot_points.cpp): position, displacement, velocity, stress, material, id,
/// rank, and its cell.
std::int64_t snapshot_bytes_per_point(const solver::Plan& plan)
{
    return 24 + 12 + 12 + 24 + 4 + 4 + 4 + (plan.plasticity ? 8 : 0) + 8 + 8 + 1;
}

/// Bytes of a point in the copy for a snapshot (solver/sand/point_copy.hpp), and in its rows.
std::int64_t snapshot_memory_per_point(const scene::Scene& scene, const solver::Plan& plan)
{
    const std::int64_t real = bytes_of_real(scene);
    return 2 * 24 + 10 * real + 4 + 1 + (plan.plasticity ? 2 * real : 0) + snapshot_bytes_per_point(plan) + 2 * 24;
}

/// Bytes of a point's variable fields (solver/sand/point_state.cpp), its id and its place in the lists.
std::int64_t checkpoint_bytes_per_point(const scene::Scene& scene, const solver::Plan& plan)
{
    const std::int64_t real = bytes_of_real(scene);
    return 24 + 10 * real + 4 + 4 + 1 + (plan.affine ? 9 * real : 0) + (plan.plasticity ? 3 * real : 0) +
           (plan.coupling ? 9 * real : 0) + (plan.cap ? real : 0) + (plan.nonlocal ? real : 0);
}

/// Bytes of the page lists in a checkpoint (kernels/mpm/pages/pages.hpp).
std::int64_t checkpoint_page_bytes(const PageCounts& pages)
{
    constexpr std::int64_t point_page = 8 + 4 + 4 * mpm::page_cells + 4 * mpm::directions + 8 * 4,
                           node_page  = 8 + 8 * 4;
    return pages.points * point_page + pages.nodes * node_page;
}

std::int64_t template_bytes(const world::World& world)
{
    std::int64_t bytes = 0;
    for (const auto& form : world.templates)
    {
        bytes += static_cast<std::int64_t>(form.sdf.bytes() + 32 * form.nodes.positions.size());
    }
    return bytes;
}

/// Bytes of the mesh for rays: triangles, at most one box for each, and 32 bytes a node.
std::int64_t ray_bytes(const world::World& world)
{
    std::int64_t bytes = 0;
    for (const auto& form : world.templates)
    {
        bytes +=
            static_cast<std::int64_t>((sizeof(dem::RayTriangle) + sizeof(dem::RayBox)) * form.mesh.triangles.size() +
                                      32 * form.nodes.positions.size());
    }
    return bytes;
}

/// s, least resting_contact of the rocks, by their own mass; 0 without rocks.
double resting_contact_of_rocks(const scene::Scene& scene, const world::World& world)
{
    double least = 0;
    for (auto b = static_cast<std::size_t>(world.bodies.named); b < world.bodies.size(); ++b)
    {
        const double time = resting_contact(scene, world, b);
        if (std::isfinite(time)) { least = least == 0 ? time : std::min(least, time); }
    }
    return least;
}

/// Measured at the peak, during the fall of a bed (docs/performance.md, "Bodies on the H200"): 1.94 to 2.7 kB for
/// bodies in contact with each other.
std::int64_t bytes_per_body(const solver::Plan& plan) { return plan.body_contact ? 2200 : 700; }

/// Extra bytes of a body that may sleep: its load, place at rest, flags and lists, and its pairs, of which a rock at
/// rest has 2.8, twice while they are sorted.
std::int64_t sleep_bytes_per_body(const solver::Plan& plan)
{
    constexpr double       pairs_a_body = 2.8;
    constexpr std::int64_t of_body = sizeof(dem::SleepWatch) + sizeof(Vec3<double>) + sizeof(Quat) + 8 + 4 * 4 + 2 * 4;
    constexpr std::int64_t of_pair = 2 * (8 + 4 + sizeof(dem::Patch) + sizeof(dem::HeldContact) + 3 * 8) + 4;
    return plan.rock_sleep ? of_body + static_cast<std::int64_t>(pairs_a_body * static_cast<double>(of_pair)) : 0;
}

/// Bytes of contacts of sleeping sand with sleeping rocks, if points cover the surface of each.
std::int64_t strewn_bed_bytes(const world::World& world, const solver::Plan& plan)
{
    if (!plan.sleep || !plan.rock_sleep) { return 0; }
    const double face = std::pow(world::largest_volume(world.sand), 2.0 / 3);
    double       rows = 0;
    for (auto b = static_cast<std::size_t>(world.bodies.named); b < world.bodies.size(); ++b)
    {
        rows += 4 * std::numbers::pi * world.bodies.radius[b] * world.bodies.radius[b] / face;
    }
    const auto of_bodies = static_cast<std::int64_t>(world.bodies.size() * (sizeof(dem::ContactWrench) + 4));
    return of_bodies + static_cast<std::int64_t>(rows * static_cast<double>(solver::sleeping_contact_bytes));
}

/// Bytes of the columns of doubles (run/recorder.cpp), which grow by 1024 rows (io/h5.cpp), and of their names.
double time_series_bytes(double rows, std::int64_t named)
{
    constexpr double of_scene = 8 * (15 + 6 + 2 + 4), of_body = 8 * 20, growth = 1024, names_of_table = 12000;
    const double     taken = std::ceil(rows / growth) * growth, bodies = static_cast<double>(named);
    return taken * (of_scene + bodies * of_body) + (5 + bodies) * names_of_table;
}

double longest_time(const scene::Scene& scene)
{
    double time = 0;
    for (const scene::Phase& phase : scene.phases)
    {
        time += phase.until == scene::StopRule::duration ? phase.duration : phase.max_duration;
    }
    return time;
}

/// First step of a run with automatic steps.
solver::TimeStep automatic_step(scene::TimeOptions options, const solver::PaceLimits& limits)
{
    options.dt.reset();
    return solver::choose_step(options, limits, {}, 0);
}

DiskUse disk_use(const scene::Scene& scene, const world::World& world, const solver::Plan& plan,
                 const PageCounts& pages)
{
    constexpr std::int64_t of_file = 30000, snapshot_of_body = 120, checkpoint_of_body = 2500;
    const auto             points   = static_cast<std::int64_t>(world.sand.size());
    const auto             bodies   = static_cast<std::int64_t>(world.bodies.size());
    const double           time     = longest_time(scene);
    const std::int64_t     snapshot = points * snapshot_bytes_per_point(plan) + bodies * snapshot_of_body + 2 * of_file;
    const double           snapshots =
        plan.snapshots ? (2 + std::floor(time / scene.output.snapshots_every)) * static_cast<double>(snapshot) : 0;
    const double       series = time_series_bytes(2 + std::floor(time / scene.output.every), world.bodies.named);
    const std::int64_t state  = points * checkpoint_bytes_per_point(scene, plan) + checkpoint_page_bytes(pages) +
                               bodies * checkpoint_of_body + of_file;
    const double checkpoints = (static_cast<double>(scene.checkpoint.keep) + 1) * (static_cast<double>(state) + series);
    const double least = static_cast<double>(plan.snapshots ? snapshot : 0) + time_series_bytes(1, world.bodies.named);
    return {saturated(snapshots), saturated(series), saturated(checkpoints), saturated(least),
            saturated(snapshots + series + checkpoints)};
}

} // namespace

double resting_contact(const scene::Scene& scene, const world::World& world, std::size_t body)
{
    constexpr double pile = 0.9, usual_overlap = 1e-3;
    const double     radius  = world.bodies.radius[body];
    const double     density = world.bodies.mass[body] / (4.0 / 3 * std::numbers::pi * std::pow(radius, 3));
    const auto&      stone   = scene.materials[static_cast<std::size_t>(world.bodies.material[body])];
    return std::isfinite(stone.young) ? pile * radius * std::sqrt(density / stone.young) *
                                            std::pow(scene.numerics.linear_overlap / usual_overlap, 0.25)
                                      : std::numeric_limits<double>::infinity();
}

std::int64_t memory_of_rank(const Estimate& wants, int ranks)
{
    if (ranks == 1) { return wants.memory_bytes; }
    return wants.copied_bytes + std::max<std::int64_t>(0, wants.memory_bytes - wants.copied_bytes) / ranks;
}

void require_room(const char* memory, std::int64_t wanted, std::int64_t free)
{
    if (0.9 * static_cast<double>(wanted) <= static_cast<double>(free)) { return; }
    throw EnvironmentError(
        fmt::format("out of {} memory: the scene wants about {}, {} is free: fewer points, a coarser "
                    "grid, or a machine with more memory",
                    memory, bytes_text(wanted), bytes_text(free)));
}

void require_disk(const std::string& directory, std::int64_t wanted, std::int64_t free)
{
    if (wanted <= free) { return; }
    throw EnvironmentError(
        fmt::format("{}: the disk is too full: the first snapshot and rows take about {}, and {} would "
                    "be free",
                    directory, bytes_text(wanted), bytes_text(free)));
}

Estimate estimate(const scene::Scene& scene, const world::World& world, const solver::Plan& plan)
{
    const auto       points = static_cast<std::int64_t>(world.sand.size());
    const auto       bodies = static_cast<std::int64_t>(world.bodies.size());
    const PageCounts pages  = plan.sand ? count_pages(world) : PageCounts{};
    Estimate         wants{};
    wants.time                = longest_time(scene);
    const std::int64_t shapes = template_bytes(world) + (plan.rays ? ray_bytes(world) : 0);
    wants.memory_bytes =
        bodies * (bytes_per_body(plan) + sleep_bytes_per_body(plan)) + shapes + strewn_bed_bytes(world, plan);
    wants.copied_bytes = shapes;
    if (plan.sand)
    {
        const std::int64_t of_point = bytes_per_point(scene, plan) + sleep_bytes_per_point(scene, plan);
        const std::int64_t sand     = points * of_point + page_bytes(scene, plan, pages);
        wants.memory_bytes += sand;
        wants.bytes_a_point = static_cast<double>(sand) / static_cast<double>(points);
    }
    wants.snapshot_bytes            = plan.snapshots ? points * snapshot_memory_per_point(scene, plan) : 0;
    wants.disk                      = disk_use(scene, world, plan, pages);
    const solver::PaceLimits limits = solver::pace_limits(scene, world, plan);
    const solver::TimeStep   first  = solver::choose_step(scene.time, limits, {}, 0);
    wants.dt                        = first.dt;
    wants.limit                     = first.limit;
    wants.automatic                 = automatic_step(scene.time, limits).dt;
    wants.hopeless = limits.wave_speed > 0 ? solver::SandGuard::hopeless_courant * limits.spacing / limits.wave_speed
                                           : std::numeric_limits<double>::infinity();
    solver::Pace resting;
    wants.node_pages         = static_cast<double>(pages.nodes);
    wants.resting_contact    = resting_contact_of_rocks(scene, world);
    resting.shortest_contact = std::sqrt(scene::mass_scaling_in(scene, scene.phases.size())) * wants.resting_contact;
    const solver::TimeStep later = solver::choose_step(scene.time, limits, resting, 0);
    wants.resting_dt             = later.dt;
    wants.substeps               = static_cast<double>(later.substeps);
    wants.steps                  = std::ceil(wants.time / later.dt);
    return wants;
}

} // namespace tread::run
