#include "world/body_grid.hpp"

#include <algorithm>
#include <cmath>

namespace tread::world
{
namespace
{

/// Whether no surface node of `one` is nearer than `margin` (m) to `other` or inside it.
bool nodes_clear(const World& world, std::size_t one, std::size_t other, double margin)
{
    const HostBodies&          bodies = world.bodies;
    const shape::SurfaceNodes& nodes  = template_of(world, one).nodes;
    const auto&                sdf    = template_of(world, other).sdf;
    const double               scale = bodies.scale[one], inverse = 1 / bodies.scale[other];
    const Mat3<double>         to_other = bodies.orientation[other].conjugate().toRotationMatrix();
    // In units of the other's template: x = turn * node + shift.
    const Mat3<double> turn   = (scale * inverse) * (to_other * bodies.orientation[one].toRotationMatrix());
    const Vec3<double> shift  = inverse * (to_other * (bodies.position[one] - bodies.position[other]));
    const double       needed = margin * inverse;
    // Bounding sphere of `other`: nodes outside it need no lookup in its distance field.
    const double beyond = template_of(world, other).bounding_radius + needed;
    // Far from the surface the interpolant of a 1-Lipschitz distance may have an error of a fraction of its cell, or
    // brick.
    const double slack = sdf.spacing * (sdf.slots.empty() ? 1 : shape::SignedDistanceGrid::brick_cells);
    for (std::size_t part = 0; part < nodes.part_centres.size(); ++part)
    {
        const Vec3<double> centre = turn * nodes.part_centres[part] + shift;
        const double       radius = nodes.part_radii[part] * scale * inverse;
        if (centre.squaredNorm() > std::pow(beyond + radius, 2)) { continue; }
        if (shape::sample(sdf, centre) > needed + radius + slack) { continue; }
        const std::size_t first = part * shape::SurfaceNodes::part_size;
        const std::size_t end   = std::min(first + shape::SurfaceNodes::part_size, nodes.positions.size());
        for (std::size_t node = first; node < end; ++node)
        {
            const Vec3<double> x = turn * nodes.positions[node] + shift;
            if (x.squaredNorm() < beyond * beyond && shape::sample(sdf, x) < needed) { return false; }
        }
    }
    return true;
}

} // namespace

double bounding_radius(const World& world, std::size_t body)
{
    return template_of(world, body).bounding_radius * world.bodies.scale[body];
}

shape::Bounds turned_box(const World& world, std::size_t body)
{
    const auto&        vertices = template_of(world, body).mesh.vertices;
    const Mat3<double> turn     = world.bodies.orientation[body].toRotationMatrix();
    shape::Bounds      box{turn * vertices.front(), turn * vertices.front()};
    for (const Vec3<double>& vertex : vertices)
    {
        const Vec3<double> place = turn * vertex;
        box                      = {box.low.cwiseMin(place), box.high.cwiseMax(place)};
    }
    return box;
}

double distance(const World& world, std::size_t body, const Vec3<double>& x)
{
    const HostBodies&  bodies = world.bodies;
    const double       scale  = bodies.scale[body];
    const Vec3<double> offset = bodies.orientation[body].conjugate() * (x - bodies.position[body]);
    return scale * shape::sample(template_of(world, body).sdf, offset / scale);
}

void BodyGrid::add(std::size_t body)
{
    const double radius   = bounding_radius(world_, body);
    const int    exponent = std::ilogb(2 * radius);
    auto         level    = std::find_if(classes_.begin(), classes_.end(),
                                         [&](const SizeClass& candidate) { return candidate.exponent == exponent; });
    if (level == classes_.end())
    {
        level = classes_.insert(classes_.end(), {exponent, 2 * radius, {}, std::vector<std::int32_t>(1024, -1)});
    }
    level->entries.push_back({world_.bodies.position[body], radius, body, -1});
    const bool wider = 2 * radius > level->width, full = level->entries.size() > level->buckets.size();
    if (!wider && !full)
    {
        link(*level, level->entries.size() - 1);
        return;
    }
    if (wider) { level->width = std::ldexp(1, exponent + 1); }
    level->buckets.assign(level->buckets.size() * (full ? 4 : 1), -1);
    for (std::size_t entry = 0; entry < level->entries.size(); ++entry) { link(*level, entry); }
}

void BodyGrid::link(SizeClass& level, std::size_t entry)
{
    const Vec3<double>& x     = level.entries[entry].centre;
    auto&               first = level.buckets[bucket(level, cell(level, x[0]), cell(level, x[1]), cell(level, x[2]))];
    level.entries[entry].next = first;
    first                     = static_cast<std::int32_t>(entry);
}

bool apart(const World& world, std::size_t one, std::size_t other, double margin)
{
    return nodes_clear(world, one, other, margin) && nodes_clear(world, other, one, margin);
}

} // namespace tread::world
