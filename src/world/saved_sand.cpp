#include "world/saved_sand.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "world/saved_value.hpp"

namespace tread::world
{
namespace
{

[[noreturn]] void refuse(const scene::Scene& scene, std::size_t table, const std::string& what)
{
    throw InputError(fmt::format("[[terrain]] {} from = \"{}\": {}", table, scene.terrain[table].from, what));
}

io::BedFile read_bed(const scene::Scene& scene, std::size_t table)
{
    try
    {
        return io::read_bed(scene.terrain[table].from);
    }
    catch (const EnvironmentError& error)
    {
        refuse(scene, table, fmt::format("{}; accepted: bed.h5 of a run with [output] bed_after", error.what()));
    }
}

void require_same(const scene::Scene& scene, std::size_t table, const std::string& what, double ours, double theirs)
{
    if (!differ(ours, theirs)) { return; }
    refuse(scene, table,
           fmt::format("{} is {:.10g} in the scene and {:.10g} in the bed; accepted: the bed's", what, ours, theirs));
}

/// Index of the table's material in the bed.
std::int32_t material_in_bed(const scene::Scene& scene, std::size_t table, const io::BedPoints& points)
{
    const std::string& name = scene.terrain[table].material;
    const auto         at   = std::find_if(points.materials.begin(), points.materials.end(),
                                           [&](const io::BedMaterial& material) { return material.name == name; });
    if (at != points.materials.end()) { return static_cast<std::int32_t>(at - points.materials.begin()); }
    std::string holds;
    for (const io::BedMaterial& material : points.materials) { holds += (holds.empty() ? "" : " | ") + material.name; }
    refuse(scene, table,
           fmt::format("it has no sand of material \"{}\"; accepted: {}", name,
                       holds.empty() ? "a bed that was saved with its sand" : holds));
}

void require_in_domain(const scene::Scene& scene, std::size_t table, const double* x)
{
    const auto& size = scene.domain.size;
    for (std::size_t c = 0; c < 3; ++c)
    {
        if (x[c] >= 0 && x[c] <= size[c]) { continue; }
        refuse(scene, table,
               fmt::format("a point of the bed at [{:.4g}, {:.4g}, {:.4g}] is outside the domain; "
                           "accepted: [domain] size of at least the bed's, now [{}, {}, {}]",
                           x[0], x[1], x[2], size[0], size[1], size[2]));
    }
}

/// Makes room for single points.
void reserve(Sand& sand, std::size_t points)
{
    sand.rows.reserve(sand.rows.size() + points);
    sand.kinds.reserve(sand.kinds.size() + points);
    sand.saved.reserve(sand.saved.size() + points);
}

} // namespace

io::BedPoints saved_points(const Communicator& communicator, const scene::Scene& scene, const World& world,
                           const io::PointFields& fields)
{
    const std::size_t   count = fields.id.size();
    std::vector<double> volume(count), mass(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        const PointKind& kind = point_of(world.sand, fields.id[i]).kind;
        volume[i]             = kind.volume * static_cast<double>(fields.volume_ratio[i]);
        mass[i]               = kind.mass;
    }
    const auto doubles = [](const std::vector<float>& values)
    { return std::vector<double>(values.begin(), values.end()); };
    io::BedPoints points;
    points.grid_spacing = scene.grid.spacing;
    for (const scene::Material& material : scene.materials)
    {
        points.materials.push_back(
            {material.name, material.density, material.young, material.poisson, material.young_pressure});
    }
    points.material      = communicator.gather(fields.material);
    points.position      = communicator.gather(fields.position);
    points.volume        = communicator.gather(volume);
    points.mass          = communicator.gather(mass);
    points.stress        = communicator.gather(doubles(fields.stress));
    points.plastic_shear = communicator.gather(doubles(fields.plastic_shear));
    points.plastic_shear.resize(points.volume.size(), 0.0);
    return points;
}

void append_saved_points(const scene::Scene& scene, std::size_t table, Sand& sand)
{
    const io::BedPoints    saved    = read_bed(scene, table).points;
    const std::int32_t     theirs   = material_in_bed(scene, table, saved);
    const int              ours     = material_index(scene, scene.terrain[table].material);
    const scene::Material& material = scene.materials[static_cast<std::size_t>(ours)];
    const io::BedMaterial& kind     = saved.materials[static_cast<std::size_t>(theirs)];
    const std::string      of       = " of material \"" + material.name + "\"";
    require_same(scene, table, "[grid] spacing", scene.grid.spacing, saved.grid_spacing);
    require_same(scene, table, "density" + of, material.density, kind.density);
    require_same(scene, table, "young" + of, material.young, kind.young);
    require_same(scene, table, "poisson" + of, material.poisson, kind.poisson);
    require_same(scene, table, "young_pressure" + of, material.young_pressure, kind.young_pressure);
    const std::size_t before = sand.size();
    reserve(sand, saved.material.size());
    for (std::size_t i = 0; i < saved.material.size(); ++i)
    {
        if (saved.material[i] != theirs) { continue; }
        const double* x = saved.position.data() + 3 * i;
        require_in_domain(scene, table, x);
        SavedState state{Sym3<double>::Zero(), saved.plastic_shear[i]};
        for (int c = 0; c < 6; ++c) { state.stress[c] = saved.stress[6 * i + static_cast<std::size_t>(c)]; }
        append(sand, alone_at(Vec3<double>(x), static_cast<std::int32_t>(sand.kinds.size())));
        sand.kinds.push_back({saved.volume[i], saved.mass[i], static_cast<std::int32_t>(table),
                              static_cast<std::int32_t>(sand.saved.size()), static_cast<std::uint8_t>(ours)});
        sand.saved.push_back(state);
    }
    if (sand.size() == before) { refuse(scene, table, "it has no point" + of); }
}

} // namespace tread::world
