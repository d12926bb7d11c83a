#include "solver/rocks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "solver/materials.hpp"

namespace tread::solver
{
namespace
{

/// Uniform over rotations (Shoemake 1992).
Quat random_rotation(Random& random)
{
    const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
                 b = 2 * std::numbers::pi * random.uniform();
    return {std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
            std::sqrt(u) * std::sin(b)};
}

/// Which bodies are near: bounding spheres on a hash grid of cells as wide as the rocks to be placed; bodies larger
/// than that are kept apart and always asked, by the distance from their surface.
class Neighbourhood
{
public:
    Neighbourhood(const World& world, double radius)
        : world_(world)
        , radius_(radius)
    {
        for (std::size_t b = 0; b < world.bodies.size(); ++b) { add(b); }
    }

    void add(std::size_t body)
    {
        if (bounding_radius(body) > radius_) { large_.push_back(body); }
        else { cells_[cell(world_.bodies.position[body])].push_back(body); }
    }

    bool free(const Vec3<double>& x) const
    {
        const auto meets = [&](std::size_t body)
        { return (world_.bodies.position[body] - x).norm() < bounding_radius(body) + radius_; };
        const auto touches = [&](std::size_t body) { return meets(body) && distance(body, x) < radius_; };
        if (std::any_of(large_.begin(), large_.end(), touches)) { return false; }
        const Cell at = cell(x);
        for (int n = 0; n < 27; ++n)
        {
            const auto found = cells_.find({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
            if (found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), meets))
            {
                return false;
            }
        }
        return true;
    }

private:
    using Cell = std::array<long, 3>;

    double bounding_radius(std::size_t body) const
    {
        const auto shape = static_cast<std::size_t>(world_.bodies.shape[body]);
        return world_.templates[shape].bounding_radius * world_.bodies.scale[body];
    }

    double distance(std::size_t body, const Vec3<double>& x) const
    {
        const auto&        form   = world_.templates[static_cast<std::size_t>(world_.bodies.shape[body])];
        const double       scale  = world_.bodies.scale[body];
        const Vec3<double> offset = world_.bodies.orientation[body].conjugate() * (x - world_.bodies.position[body]);
        return scale * shape::sample(form.sdf, offset / scale);
    }

    Cell cell(const Vec3<double>& x) const
    {
        const double width = 2 * radius_;
        return {static_cast<long>(std::floor(x[0] / width)), static_cast<long>(std::floor(x[1] / width)),
                static_cast<long>(std::floor(x[2] / width))};
    }

    const World&                             world_;
    double                                   radius_;
    std::vector<std::size_t>                 large_;
    std::map<Cell, std::vector<std::size_t>> cells_;
};

std::string box_text(const scene::Box& box)
{
    return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", box.low[0], box.low[1], box.low[2], box.high[0], box.high[1],
                       box.high[2]);
}

/// Where centres may be: the region less the bounding radius on every side.
scene::Box centres(const scene::Rocks& rocks, double radius)
{
    scene::Box box = rocks.region;
    for (std::size_t c = 0; c < 3; ++c)
    {
        box.low[c] += radius;
        box.high[c] -= radius;
        if (box.low[c] > box.high[c])
        {
            throw InputError(fmt::format("[[rocks]] of shape '{}': region {} is thinner along {} than one rock "
                                         "(bounding diameter {:.4g} m)",
                                         rocks.shape, box_text(rocks.region), "xyz"[c], 2 * radius));
        }
    }
    return box;
}

/// Throws when a table's rocks do not fit: says how many did.
[[noreturn]] void refuse(const scene::Rocks& rocks, std::int64_t placed, double radius)
{
    throw InputError(fmt::format("[[rocks]] of shape '{}': only {} of count = {} fit into region {} without overlap "
                                 "(bounding diameter {:.4g} m); enlarge the region, or lower count or diameter",
                                 rocks.shape, placed, rocks.count, box_text(rocks.region), 2 * radius));
}

std::vector<Vec3<double>> lattice(const scene::Box& box, double spacing)
{
    std::vector<Vec3<double>> sites;
    const auto                along = [&](std::size_t c)
    { return static_cast<long>((box.high[c] - box.low[c]) / spacing + 1e-9) + 1; };
    for (long k = 0; k < along(2); ++k)
    {
        for (long j = 0; j < along(1); ++j)
        {
            for (long i = 0; i < along(0); ++i)
            {
                sites.emplace_back(box.low[0] + spacing * double(i), box.low[1] + spacing * double(j),
                                   box.low[2] + spacing * double(k));
            }
        }
    }
    return sites;
}

void add_rock(const scene::Scene& scene, const scene::Rocks& rocks, int shape_index, const Vec3<double>& x,
              const Quat& rotation, World& world)
{
    const auto&  shape    = world.templates[static_cast<std::size_t>(shape_index)];
    const int    material = material_index(scene, rocks.material);
    const double scale    = 0.5 * rocks.diameter / shape.equivalent_radius;
    HostBodies&  bodies   = world.bodies;
    bodies.position.push_back(x);
    bodies.orientation.push_back(rotation);
    bodies.velocity.push_back(Vec3<double>::Zero());
    bodies.mass.push_back(scene.materials[static_cast<std::size_t>(material)].density * shape.unit.volume * scale *
                          scale * scale);
    bodies.scale.push_back(scale);
    bodies.radius.push_back(0.5 * rocks.diameter);
    bodies.shape.push_back(shape_index);
    bodies.material.push_back(material);
}

int template_index(const World& world, const std::string& name)
{
    const auto at = std::find_if(world.templates.begin(), world.templates.end(),
                                 [&](const auto& shape) { return shape.name == name; });
    return static_cast<int>(at - world.templates.begin());
}

} // namespace

std::int64_t remove_points_in_body(const scene::Scene& scene, World& world, std::size_t body)
{
    const auto&        shape   = world.templates[static_cast<std::size_t>(world.bodies.shape[body])];
    const double       scale   = world.bodies.scale[body];
    const Vec3<double> centre  = world.bodies.position[body];
    const Mat3<double> to_body = world.bodies.orientation[body].toRotationMatrix().transpose();
    HostPoints&        points  = world.points;
    const auto         rule    = radius_rule(scene.numerics.point_radius);
    std::size_t        kept    = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const Vec3<double> offset = points.position[i] - centre;
        const double       radius = contact::point_radius(points.volume[i], rule);
        if (offset.norm() < shape.bounding_radius * scale + radius &&
            scale * shape::sample(shape.sdf, to_body * offset / scale) < radius)
        {
            continue;
        }
        points.position[kept] = points.position[i];
        points.volume[kept]   = points.volume[i];
        points.mass[kept]     = points.mass[i];
        points.stress[kept]   = points.stress[i];
        points.material[kept] = points.material[i];
        ++kept;
    }
    const auto removed = static_cast<std::int64_t>(points.size() - kept);
    points.position.resize(kept);
    points.volume.resize(kept);
    points.mass.resize(kept);
    points.stress.resize(kept);
    points.material.resize(kept);
    return removed;
}

void place_rocks(const scene::Scene& scene, const scene::Rocks& rocks, World& world)
{
    const int         shape  = template_index(world, rocks.shape);
    const auto&       form   = world.templates[static_cast<std::size_t>(shape)];
    const double      radius = form.bounding_radius * 0.5 * rocks.diameter / form.equivalent_radius;
    const scene::Box  box    = centres(rocks, radius);
    const std::size_t first  = world.bodies.size();
    Neighbourhood     near(world, radius);
    Random            random(rocks.seed);

    std::vector<Vec3<double>> sites;
    if (rocks.placement == scene::Placement::grid) { sites = lattice(box, 2 * radius); }
    const std::int64_t tries =
        rocks.placement == scene::Placement::grid ? static_cast<std::int64_t>(sites.size()) : 10000 + 200 * rocks.count;
    std::int64_t placed = 0;
    for (std::int64_t attempt = 0; placed < rocks.count; ++attempt)
    {
        if (attempt == tries) { refuse(rocks, placed, radius); }
        const Vec3<double> x =
            rocks.placement == scene::Placement::grid
                ? sites[static_cast<std::size_t>(attempt)]
                : Vec3<double>(random.uniform(box.low[0], box.high[0]), random.uniform(box.low[1], box.high[1]),
                               random.uniform(box.low[2], box.high[2]));
        const Quat rotation = random_rotation(random);
        if (!near.free(x)) { continue; }
        add_rock(scene, rocks, shape, x, rotation, world);
        near.add(world.bodies.size() - 1);
        ++placed;
    }
    for (std::size_t body = first; body < world.bodies.size(); ++body)
    {
        const std::int64_t removed = remove_points_in_body(scene, world, body);
        if (removed > 0 && rocks.placement != scene::Placement::replace)
        {
            throw InputError(
                fmt::format("[[rocks]] of shape '{}': {} points of sand stand where rock {} is placed; use "
                            "placement = \"replace\" or another region",
                            rocks.shape, removed, body - first));
        }
    }
}

} // namespace tread::solver
