#include "io/bed_file.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/files.hpp"
#include "io/h5.hpp"

namespace tread::io
{
namespace
{

constexpr const char* format_name = "tread bed 1";

template<class T>
void write_with_unit(const h5::File& file, const std::string& name, const std::vector<T>& values, int width,
                     const std::string& unit)
{
    h5::write(file, name, values, width);
    h5::write_attribute(file, name, "units", unit);
}

void write_kinds(const h5::File& file, const std::vector<BedKind>& kinds)
{
    h5::create_group(file, "/kinds");
    for (std::size_t k = 0; k < kinds.size(); ++k)
    {
        const std::string group = fmt::format("/kinds/{}", k);
        h5::create_group(file, group);
        h5::write_attribute(file, group, "shape", kinds[k].shape);
        h5::write_attribute(file, group, "member", kinds[k].member);
        h5::write_attribute(file, group, "material", kinds[k].material);
        h5::write_attribute(file, group, "inertia", kinds[k].inertia);
        h5::write_attribute(file, group, "density", kinds[k].density);
        h5::write_attribute(file, group, "young", kinds[k].young);
        h5::write_attribute(file, group, "poisson", kinds[k].poisson);
    }
}

std::vector<BedKind> read_kinds(const h5::File& file)
{
    std::vector<BedKind> kinds;
    const std::int64_t   count = h5::count_members(file, "/kinds");
    for (std::int64_t k = 0; k < count; ++k)
    {
        const std::string group  = fmt::format("/kinds/{}", k);
        const auto        text   = [&](const char* name) { return h5::read_text_attribute(file, group, name); };
        const auto        number = [&](const char* name) { return h5::read_number_attribute(file, group, name); };
        kinds.push_back({text("shape"), text("member"), text("material"), number("inertia"), number("density"),
                         number("young"), number("poisson")});
    }
    return kinds;
}

void write_points(const h5::File& file, const BedPoints& points)
{
    h5::create_group(file, "/points");
    h5::write_attribute(file, "/points", "grid_spacing", points.grid_spacing);
    h5::create_group(file, "/materials");
    for (std::size_t m = 0; m < points.materials.size(); ++m)
    {
        const std::string group = fmt::format("/materials/{}", m);
        h5::create_group(file, group);
        h5::write_attribute(file, group, "name", points.materials[m].name);
        h5::write_attribute(file, group, "density", points.materials[m].density);
        h5::write_attribute(file, group, "young", points.materials[m].young);
        h5::write_attribute(file, group, "poisson", points.materials[m].poisson);
    }
    write_with_unit(file, "/points/material", points.material, 1, "1");
    write_with_unit(file, "/points/position", points.position, 3, "m");
    write_with_unit(file, "/points/volume", points.volume, 1, "m3");
    write_with_unit(file, "/points/mass", points.mass, 1, "kg");
    write_with_unit(file, "/points/stress", points.stress, 6, "Pa");
    write_with_unit(file, "/points/plastic_shear", points.plastic_shear, 1, "1");
}

BedPoints read_points(const h5::File& file)
{
    BedPoints points;
    if (!h5::holds(file, "/points")) { return points; }
    points.grid_spacing = h5::read_number_attribute(file, "/points", "grid_spacing");
    for (std::int64_t m = 0; m < h5::count_members(file, "/materials"); ++m)
    {
        const std::string group  = fmt::format("/materials/{}", m);
        const auto        number = [&](const char* name) { return h5::read_number_attribute(file, group, name); };
        points.materials.push_back(
            {h5::read_text_attribute(file, group, "name"), number("density"), number("young"), number("poisson")});
    }
    points.material      = h5::read<std::int32_t>(file, "/points/material", 1);
    points.position      = h5::read<double>(file, "/points/position", 3);
    points.volume        = h5::read<double>(file, "/points/volume", 1);
    points.mass          = h5::read<double>(file, "/points/mass", 1);
    points.stress        = h5::read<double>(file, "/points/stress", 6);
    points.plastic_shear = h5::read<double>(file, "/points/plastic_shear", 1);
    return points;
}

[[noreturn]] void refuse(const std::string& path, const char* what)
{
    throw EnvironmentError(fmt::format("{}: the bed is damaged: {}", path, what));
}

void require_rows(const std::string& path, std::size_t rows, const std::vector<std::size_t>& sizes)
{
    if (std::any_of(sizes.begin(), sizes.end(), [&](std::size_t size) { return size != rows; }))
    {
        refuse(path, "its columns have not the same length");
    }
}

void require_points_in_range(const std::string& path, const BedPoints& points)
{
    const auto finite   = [](double value) { return std::isfinite(value); };
    const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
    const auto known    = [&](std::int32_t material)
    { return material >= 0 && static_cast<std::size_t>(material) < points.materials.size(); };
    const auto all = [](const auto& values, const auto& holds)
    { return std::all_of(values.begin(), values.end(), holds); };
    if (!all(points.material, known)) { refuse(path, "a point is of no material"); }
    if (!all(points.position, finite) || !all(points.stress, finite) || !all(points.plastic_shear, finite) ||
        !all(points.volume, positive) || !all(points.mass, positive))
    {
        refuse(path, "a point has no finite place, size or stress");
    }
}

void require_in_range(const std::string& path, const BedFile& bed)
{
    const auto         finite   = [](double value) { return std::isfinite(value); };
    const auto         positive = [](double value) { return std::isfinite(value) && value > 0; };
    const BedContacts& contacts = bed.contacts;
    const auto         all      = [](const auto& values, const auto& holds)
    { return std::all_of(values.begin(), values.end(), holds); };
    const auto known = [&](std::int32_t kind)
    { return kind >= 0 && static_cast<std::size_t>(kind) < bed.kinds.size(); };
    if (!all(bed.kind, known)) { refuse(path, "a rock is of no kind"); }
    if (!all(bed.position, finite) || !all(bed.orientation, finite) || !all(bed.scale, positive) ||
        !all(bed.diameter, positive))
    {
        refuse(path, "a rock has no finite place or size");
    }
    for (std::size_t q = 0; q < bed.orientation.size(); q += 4)
    {
        const auto turn = bed.orientation.begin() + static_cast<std::ptrdiff_t>(q);
        if (std::abs(std::inner_product(turn, turn + 4, turn, 0.0) - 1) > 1e-9)
        {
            refuse(path, "a rock's orientation is no unit quaternion");
        }
    }
    constexpr std::int64_t walls = 6;
    const auto             count = static_cast<std::int64_t>(bed.size());
    for (std::size_t i = 0; i < contacts.stiffness.size(); ++i)
    {
        const std::int64_t a = contacts.pair[2 * i], b = contacts.pair[2 * i + 1];
        if (a < 0 || a >= b || a >= count || b >= count + walls) { refuse(path, "a contact names no pair"); }
    }
    for (const auto* values :
         {&contacts.tangential, &contacts.normal, &contacts.torsion, &contacts.stiffness, &contacts.twist_stiffness,
          &contacts.place, &contacts.rolling, &contacts.rolling_stiffness})
    {
        if (!all(*values, finite)) { refuse(path, "a contact is not finite"); }
    }
}

} // namespace

void write_bed(const std::string& path, const BedFile& bed, const Provenance& provenance)
{
    const std::string temporary = path + ".tmp";
    h5::File          file      = h5::File::create(temporary);
    h5::write_attribute(file, "/", "format", format_name);
    write_provenance(file, provenance);
    write_kinds(file, bed.kinds);
    h5::create_group(file, "/rocks");
    write_with_unit(file, "/rocks/kind", bed.kind, 1, "1");
    write_with_unit(file, "/rocks/position", bed.position, 3, "m");
    write_with_unit(file, "/rocks/orientation", bed.orientation, 4, "1");
    write_with_unit(file, "/rocks/scale", bed.scale, 1, "1");
    write_with_unit(file, "/rocks/diameter", bed.diameter, 1, "m");
    h5::create_group(file, "/contacts");
    write_with_unit(file, "/contacts/pair", bed.contacts.pair, 2, "1");
    write_with_unit(file, "/contacts/tangential", bed.contacts.tangential, 3, "N");
    write_with_unit(file, "/contacts/normal", bed.contacts.normal, 3, "1");
    write_with_unit(file, "/contacts/torsion", bed.contacts.torsion, 1, "N m");
    write_with_unit(file, "/contacts/stiffness", bed.contacts.stiffness, 1, "N/m");
    write_with_unit(file, "/contacts/twist_stiffness", bed.contacts.twist_stiffness, 1, "N m/rad");
    write_with_unit(file, "/contacts/place", bed.contacts.place, 3, "m");
    write_with_unit(file, "/contacts/rolling", bed.contacts.rolling, 3, "N m");
    write_with_unit(file, "/contacts/rolling_stiffness", bed.contacts.rolling_stiffness, 1, "N m/rad");
    if (!bed.points.volume.empty()) { write_points(file, bed.points); }
    file.close();
    rename_file(temporary, path);
}

BedFile read_bed(const std::string& path)
{
    const h5::File file = h5::File::open(path);
    if (h5::read_text_attribute(file, "/", "format") != format_name) { refuse(path, "it has another format"); }
    BedFile bed;
    bed.kinds       = read_kinds(file);
    bed.kind        = h5::read<std::int32_t>(file, "/rocks/kind", 1);
    bed.position    = h5::read<double>(file, "/rocks/position", 3);
    bed.orientation = h5::read<double>(file, "/rocks/orientation", 4);
    bed.scale       = h5::read<double>(file, "/rocks/scale", 1);
    bed.diameter    = h5::read<double>(file, "/rocks/diameter", 1);
    require_rows(path, bed.size(),
                 {bed.position.size() / 3, bed.orientation.size() / 4, bed.scale.size(), bed.diameter.size()});
    BedContacts& contacts      = bed.contacts;
    contacts.pair              = h5::read<std::int32_t>(file, "/contacts/pair", 2);
    contacts.tangential        = h5::read<double>(file, "/contacts/tangential", 3);
    contacts.normal            = h5::read<double>(file, "/contacts/normal", 3);
    contacts.torsion           = h5::read<double>(file, "/contacts/torsion", 1);
    contacts.stiffness         = h5::read<double>(file, "/contacts/stiffness", 1);
    contacts.twist_stiffness   = h5::read<double>(file, "/contacts/twist_stiffness", 1);
    contacts.place             = h5::read<double>(file, "/contacts/place", 3);
    contacts.rolling           = h5::read<double>(file, "/contacts/rolling", 3);
    contacts.rolling_stiffness = h5::read<double>(file, "/contacts/rolling_stiffness", 1);
    require_rows(path, contacts.stiffness.size(),
                 {contacts.pair.size() / 2, contacts.tangential.size() / 3, contacts.normal.size() / 3,
                  contacts.torsion.size(), contacts.twist_stiffness.size(), contacts.place.size() / 3,
                  contacts.rolling.size() / 3, contacts.rolling_stiffness.size()});
    require_in_range(path, bed);
    bed.points = read_points(file);
    require_rows(path, bed.points.volume.size(),
                 {bed.points.material.size(), bed.points.position.size() / 3, bed.points.mass.size(),
                  bed.points.stress.size() / 6, bed.points.plastic_shear.size()});
    require_points_in_range(path, bed.points);
    return bed;
}

} // namespace tread::io
