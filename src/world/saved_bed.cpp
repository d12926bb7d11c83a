#include "world/saved_bed.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "scene/named.hpp"
#include "world/body_grid.hpp"
#include "world/rocks.hpp"
#include "world/saved_value.hpp"

namespace tread::world
{
namespace
{

constexpr double deepest_in_wall = 0.1; ///< overlap over radius: settled rocks overlap a wall by far less

/// 0 to 5, the wall's number in io::BedContacts.
int wall_number(const dem::Plane& plane)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        if (plane.normal[axis] != 0) { return 2 * axis + (plane.normal[axis] > 0 ? 0 : 1); }
    }
    return -1;
}

/// Converts a record to the pair's reversed order: `from` = the first body before, `to` = the first one after.
ContactRecord turned_over(ContactRecord contact, const HostBodies& bodies, std::size_t from, std::size_t to)
{
    const Vec3<double> place = bodies.position[from] + bodies.orientation[from] * contact.place;
    contact.place            = bodies.orientation[to].conjugate() * (place - bodies.position[to]);
    contact.patch.tangential = -contact.patch.tangential;
    contact.patch.normal     = -contact.patch.normal;
    contact.rolling.moment   = -contact.rolling.moment;
    contact.rolling.normal   = -contact.rolling.normal;
    return contact;
}

void append(std::vector<double>& values, const Vec3<double>& vector)
{
    values.insert(values.end(), vector.data(), vector.data() + 3);
}

void append(io::BedContacts& contacts, std::int32_t first, std::int32_t second, const ContactRecord& record)
{
    const dem::Patch& patch = record.patch;
    contacts.pair.insert(contacts.pair.end(), {first, second});
    append(contacts.tangential, patch.tangential);
    append(contacts.normal, patch.normal);
    contacts.torsion.push_back(patch.torsion);
    contacts.stiffness.push_back(patch.stiffness);
    contacts.twist_stiffness.push_back(patch.twist_stiffness);
    append(contacts.place, record.place);
    append(contacts.rolling, record.rolling.moment);
    contacts.rolling_stiffness.push_back(record.rolling.stiffness);
}

ContactRecord record_of(const io::BedContacts& contacts, std::size_t i)
{
    return {0,
            {Vec3<double>(contacts.tangential.data() + 3 * i), Vec3<double>(contacts.normal.data() + 3 * i),
             contacts.torsion[i], contacts.stiffness[i], contacts.twist_stiffness[i]},
            {Vec3<double>(contacts.rolling.data() + 3 * i), contacts.rolling_stiffness[i],
             Vec3<double>(contacts.normal.data() + 3 * i)},
            Vec3<double>(contacts.place.data() + 3 * i)};
}

std::vector<io::BedKind> kinds_of_table(const scene::Scene& scene, std::size_t table, const World& world)
{
    const auto& material =
        scene.materials[static_cast<std::size_t>(material_index(scene, scene.rocks[table].material))];
    std::vector<io::BedKind> kinds;
    for (const auto& form : world.templates)
    {
        kinds.push_back({scene.rocks[table].shape, form.name, material.name, form.unit.inertia.trace(),
                         material.density, material.young, material.poisson});
    }
    return kinds;
}

/// Removes kinds that no rock has.
void drop_unused_kinds(io::BedFile& bed)
{
    std::vector<std::int32_t> place(bed.kinds.size(), -1);
    std::vector<io::BedKind>  used;
    for (std::int32_t& kind : bed.kind)
    {
        std::int32_t& at = place[static_cast<std::size_t>(kind)];
        if (at < 0)
        {
            at = static_cast<std::int32_t>(used.size());
            used.push_back(bed.kinds[static_cast<std::size_t>(kind)]);
        }
        kind = at;
    }
    bed.kinds = std::move(used);
}

} // namespace

io::BedFile make_bed(const scene::Scene& scene, const World& world, const io::BodyFields& bodies,
                     const std::vector<ContactRecord>& contacts)
{
    io::BedFile bed;
    const auto  named = static_cast<std::size_t>(world.bodies.named), count = world.bodies.size();
    std::size_t first = named;
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        const auto before = static_cast<std::int32_t>(bed.kinds.size());
        const auto kinds  = kinds_of_table(scene, table, world);
        bed.kinds.insert(bed.kinds.end(), kinds.begin(), kinds.end());
        for (; first < world.bodies.rocks_end[table]; ++first)
        {
            const std::int32_t shape = bodies.shape[first];
            bed.kind.push_back(before + shape);
            bed.diameter.push_back(bodies.scale[first] *
                                   volume_diameter(world.templates[static_cast<std::size_t>(shape)]));
        }
    }
    const auto from = [&](const std::vector<double>& values, std::size_t width)
    { return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(width * named), values.end()); };
    bed.position    = from(bodies.position, 3);
    bed.orientation = from(bodies.orientation, 4);
    bed.scale       = from(bodies.scale, 1);
    drop_unused_kinds(bed);
    for (const ContactRecord& contact : contacts)
    {
        const auto a = static_cast<std::size_t>(dem::first_of(contact.key)),
                   b = static_cast<std::size_t>(dem::second_of(contact.key));
        if (a < named || b < named) { continue; }
        const auto second =
            b < count ? b - named : count - named + static_cast<std::size_t>(wall_number(world.planes[b - count]));
        append(bed.contacts, static_cast<std::int32_t>(a - named), static_cast<std::int32_t>(second), contact);
    }
    return bed;
}

SavedBeds::SavedBeds(const scene::Scene& scene)
    : scene_(scene)
    , touch_(touch_table(scene, 0))
{
    for (std::size_t table = 0; table < scene.rocks.size(); ++table)
    {
        const std::string& path = scene.rocks[table].from;
        if (path.empty() || beds_.count(path) > 0) { continue; }
        try
        {
            Bed bed{io::read_bed(path), {}};
            bed.body.assign(bed.file.size(), -1);
            beds_.emplace(path, std::move(bed));
        }
        catch (const EnvironmentError& error)
        {
            refuse(table, fmt::format("{}; accepted: bed.h5 of a run with [output] bed_after", error.what()));
        }
    }
}

void SavedBeds::refuse(std::size_t table, const std::string& what) const
{
    throw InputError(fmt::format("[[rocks]] {} from = \"{}\": {}", table, scene_.rocks[table].from, what));
}

const SavedBeds::Bed& SavedBeds::bed(std::size_t table) const { return beds_.at(scene_.rocks[table].from); }

std::vector<std::size_t> SavedBeds::taken(std::size_t table) const
{
    const scene::Rocks&      rocks = scene_.rocks[table];
    const io::BedFile&       file  = bed(table).file;
    std::vector<std::size_t> found;
    std::string              holds;
    for (std::size_t rock = 0; rock < file.size(); ++rock)
    {
        const io::BedKind& kind = file.kinds[static_cast<std::size_t>(file.kind[rock])];
        if (kind.shape == rocks.shape && kind.material == rocks.material) { found.push_back(rock); }
    }
    if (!found.empty()) { return found; }
    for (const io::BedKind& kind : file.kinds)
    {
        const auto pair = fmt::format("shape = \"{}\", material = \"{}\"", kind.shape, kind.material);
        if (holds.find(pair) == std::string::npos) { holds += (holds.empty() ? "" : " | ") + pair; }
    }
    refuse(table, fmt::format("it has no rocks of shape \"{}\" and material \"{}\"; accepted: {}", rocks.shape,
                              rocks.material, holds));
}

std::vector<RockDraw> SavedBeds::draws(std::size_t table) const
{
    const auto            family = rocks_family(scene_, table);
    const io::BedFile&    file   = bed(table).file;
    std::vector<RockDraw> drawn;
    for (const std::size_t rock : taken(table))
    {
        const std::string& member = file.kinds[static_cast<std::size_t>(file.kind[rock])].member;
        const std::size_t  at     = scene::index_of(family, member);
        if (at == family.size())
        {
            refuse(table, fmt::format("the bed's rock \"{}\" is none of shape \"{}\", which has {} variants; accepted: "
                                      "the shape that the bed was made with",
                                      member, scene_.rocks[table].shape, family.size()));
        }
        drawn.push_back({file.diameter[rock], static_cast<std::int32_t>(at)});
    }
    return drawn;
}

void SavedBeds::require_same_kind(std::size_t table, const io::BedKind& kind, const shape::ShapeTemplate& form) const
{
    const auto& material =
        scene_.materials[static_cast<std::size_t>(material_index(scene_, scene_.rocks[table].material))];
    const auto require = [&](const char* what, double ours, double theirs)
    {
        if (!differ(ours, theirs)) { return; }
        refuse(table, fmt::format("{} is {:.10g} in the scene and {:.10g} in the bed; accepted: the bed's", what, ours,
                                  theirs));
    };
    require(("the moment of inertia of shape \"" + form.name + "\"").c_str(), form.unit.inertia.trace(), kind.inertia);
    const std::string of = " of material \"" + material.name + "\"";
    require(("density" + of).c_str(), material.density, kind.density);
    require(("young" + of).c_str(), material.young, kind.young);
    require(("poisson" + of).c_str(), material.poisson, kind.poisson);
}

void SavedBeds::require_room(std::size_t table, std::size_t body, const World& world) const
{
    const HostBodies&  bodies = world.bodies;
    const auto&        size   = scene_.domain.size;
    const auto&        form   = template_of(world, body);
    const Mat3<double> turn   = bodies.scale[body] * bodies.orientation[body].toRotationMatrix();
    const double       margin = deepest_in_wall * bodies.radius[body];
    double             beyond = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
        const double at = bodies.position[body][static_cast<int>(c)];
        beyond          = std::max({beyond, -at, at - size[c]});
    }
    for (const dem::Plane& plane : world.planes)
    {
        const double height = plane.normal.dot(bodies.position[body]) - plane.offset;
        if (height > bounding_radius(world, body)) { continue; }
        for (const Vec3<double>& node : form.nodes.positions)
        {
            beyond = std::max(beyond, -height - plane.normal.dot(turn * node) - margin);
        }
    }
    if (beyond > 0)
    {
        refuse(table, fmt::format("a rock of the bed at [{:.4g}, {:.4g}, {:.4g}] is {:.3g} m outside the domain; "
                                  "accepted: [domain] size of at least the bed's, now [{}, {}, {}]",
                                  bodies.position[body][0], bodies.position[body][1], bodies.position[body][2],
                                  beyond + margin, size[0], size[1], size[2]));
    }
    for (std::size_t named = 0; named < static_cast<std::size_t>(bodies.named); ++named)
    {
        if (!touch_(bodies.material[body], bodies.material[named])) { continue; }
        const double reach = bounding_radius(world, body) + bounding_radius(world, named);
        if ((bodies.position[body] - bodies.position[named]).norm() > reach || apart(world, body, named, 0))
        {
            continue;
        }
        refuse(table, fmt::format("a rock of the bed at [{:.4g}, {:.4g}, {:.4g}] is inside [[body]] '{}'; accepted: a "
                                  "position of the body that is clear of the bed",
                                  bodies.position[body][0], bodies.position[body][1], bodies.position[body][2],
                                  scene_.bodies[named].name));
    }
}

void SavedBeds::place(std::size_t table, World& world)
{
    HostBodies&        bodies   = world.bodies;
    Bed&               from     = beds_.at(scene_.rocks[table].from);
    const auto         material = material_index(scene_, scene_.rocks[table].material);
    const io::BedFile& file     = from.file;
    for (const std::size_t rock : taken(table))
    {
        const io::BedKind& kind  = file.kinds[static_cast<std::size_t>(file.kind[rock])];
        const auto         shape = template_index(world, kind.member);
        const auto&        form  = world.templates[static_cast<std::size_t>(shape)];
        const double*      turn  = file.orientation.data() + 4 * rock;
        if (from.body[rock] >= 0)
        {
            refuse(table, "another [[rocks]] table takes the same rocks; accepted: one of them");
        }
        require_same_kind(table, kind, form);
        from.body[rock] = static_cast<std::int64_t>(bodies.size());
        bodies.position.emplace_back(file.position.data() + 3 * rock);
        bodies.orientation.emplace_back(turn[0], turn[1], turn[2], turn[3]);
        bodies.mass.push_back(kind.density * form.unit.volume * std::pow(file.scale[rock], 3));
        bodies.scale.push_back(file.scale[rock]);
        bodies.radius.push_back(0.5 * file.diameter[rock]);
        bodies.shape.push_back(shape);
        bodies.material.push_back(material);
        require_room(table, bodies.size() - 1, world);
    }
}

void SavedBeds::add_contacts(const Bed& bed, World& world)
{
    const io::BedContacts& contacts = bed.file.contacts;
    const auto             rocks    = static_cast<std::int32_t>(bed.file.size());
    const auto             count    = static_cast<std::int64_t>(world.bodies.size());
    for (std::size_t i = 0; i < contacts.stiffness.size(); ++i)
    {
        const std::int64_t a      = bed.body[static_cast<std::size_t>(contacts.pair[2 * i])];
        const std::int32_t second = contacts.pair[2 * i + 1];
        ContactRecord      record = record_of(contacts, i);
        if (second < rocks)
        {
            const std::int64_t b = bed.body[static_cast<std::size_t>(second)];
            record.key           = dem::pair_key(std::min(a, b), std::max(a, b));
            world.contacts.push_back(
                a < b ? record
                      : turned_over(record, world.bodies, static_cast<std::size_t>(a), static_cast<std::size_t>(b)));
            continue;
        }
        const auto wall = std::find_if(world.planes.begin(), world.planes.end(),
                                       [&](const dem::Plane& plane) { return wall_number(plane) == second - rocks; });
        if (wall == world.planes.end()) { continue; }
        record.key = dem::pair_key(a, count + (wall - world.planes.begin()));
        world.contacts.push_back(record);
    }
}

void SavedBeds::finish(World& world) const
{
    for (const auto& [path, bed] : beds_)
    {
        const auto left = std::find(bed.body.begin(), bed.body.end(), -1);
        if (left != bed.body.end())
        {
            const auto& kind =
                bed.file
                    .kinds[static_cast<std::size_t>(bed.file.kind[static_cast<std::size_t>(left - bed.body.begin())])];
            throw InputError(fmt::format("[[rocks]] from = \"{}\": no table takes the bed's rocks of shape \"{}\" and "
                                         "material \"{}\", on which others may lie; accepted: a table for each",
                                         path, kind.shape, kind.material));
        }
        add_contacts(bed, world);
    }
    std::stable_sort(world.contacts.begin(), world.contacts.end(),
                     [](const ContactRecord& a, const ContactRecord& b) { return a.key < b.key; });
}

} // namespace tread::world
