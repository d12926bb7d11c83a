#include "io/bed_file.hpp"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "io/accept.hpp"
#include "io/describe.hpp"
#include "io/files.hpp"
#include "io/h5.hpp"
#include "io/in_child.hpp"

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
        h5::write_attribute(file, group, "young_pressure", points.materials[m].young_pressure);
    }
    write_with_unit(file, "/points/material", points.material, 1, "1");
    write_with_unit(file, "/points/position", points.position, 3, "m");
    write_with_unit(file, "/points/volume", points.volume, 1, "m3");
    write_with_unit(file, "/points/mass", points.mass, 1, "kg");
    write_with_unit(file, "/points/stress", points.stress, 6, "Pa");
    write_with_unit(file, "/points/plastic_shear", points.plastic_shear, 1, "1");
}

[[noreturn]] void refuse(const std::string& path, const std::string& what)
{
    throw EnvironmentError(fmt::format("{}: the bed cannot be used: {}", path, what));
}

/// Reads a data set that must have `count` rows and values within the bound.
template<class T, class Bound>
std::vector<T> read_rows(const h5::File& file, const std::string& name, int width, std::size_t rows,
                         const Bound& accepted)
{
    std::vector<T>    values = h5::read<T>(file, name, width);
    const auto        size   = static_cast<std::size_t>(width);
    const std::size_t found  = values.size() / size;
    if (found != rows)
    {
        refuse(file.path(), fmt::format("{}: {} rows; accepted: {}, as of what stands beside it", name, found, rows));
    }
    if (const accept::Verdict refusal = accepted(values))
    {
        refuse(file.path(),
               fmt::format("{} row {}: {}; accepted: {}", name, refusal->row / static_cast<std::int64_t>(size),
                           refusal->value, refusal->accepted));
    }
    return values;
}

std::size_t rows_of(const h5::File& file, const std::string& name)
{
    return static_cast<std::size_t>(h5::count_rows(file, name));
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
        // Beds that were made before the key have no such attribute, and one modulus for all pressures.
        const bool stiffens = h5::holds_attribute(file, group, "young_pressure");
        points.materials.push_back({h5::read_text_attribute(file, group, "name"), number("density"), number("young"),
                                    number("poisson"), stiffens ? number("young_pressure") : 0});
    }
    const std::size_t count     = rows_of(file, "/points/material");
    const auto        materials = accept::index(points.materials.size());

    points.material      = read_rows<std::int32_t>(file, "/points/material", 1, count, materials);
    points.position      = read_rows<double>(file, "/points/position", 3, count, accept::finite());
    points.volume        = read_rows<double>(file, "/points/volume", 1, count, accept::positive());
    points.mass          = read_rows<double>(file, "/points/mass", 1, count, accept::positive());
    points.stress        = read_rows<double>(file, "/points/stress", 6, count, accept::finite());
    points.plastic_shear = read_rows<double>(file, "/points/plastic_shear", 1, count, accept::finite());
    return points;
}

/// Accepts quaternions of unit length, four numbers each.
accept::Verdict unit_quaternions(const std::vector<double>& values)
{
    for (std::size_t q = 0; q < values.size(); q += 4)
    {
        const auto   turn   = values.begin() + static_cast<std::ptrdiff_t>(q);
        const double square = std::inner_product(turn, turn + 4, turn, 0.0);
        if (std::abs(square - 1) <= 1e-9) { continue; }
        return accept::Refusal{static_cast<std::int64_t>(q), fmt::format("a length of {}", std::sqrt(square)),
                               "a quaternion of length 1"};
    }
    return {};
}

void read_rocks(const h5::File& file, BedFile& bed)
{
    const std::size_t count = rows_of(file, "/rocks/kind");
    bed.kind                = read_rows<std::int32_t>(file, "/rocks/kind", 1, count, accept::index(bed.kinds.size()));
    bed.position            = read_rows<double>(file, "/rocks/position", 3, count, accept::finite());
    bed.orientation         = read_rows<double>(file, "/rocks/orientation", 4, count, unit_quaternions);
    bed.scale               = read_rows<double>(file, "/rocks/scale", 1, count, accept::positive());
    bed.diameter            = read_rows<double>(file, "/rocks/diameter", 1, count, accept::positive());
}

/// Accepts pairs of a rock and a later rock, or a wall: two numbers each.
auto pairs_of(std::size_t rocks)
{
    return [rocks](const std::vector<std::int32_t>& values) -> accept::Verdict
    {
        constexpr std::int64_t walls = 6;
        const auto             count = static_cast<std::int64_t>(rocks);
        for (std::size_t i = 0; i < values.size(); i += 2)
        {
            const std::int64_t a = values[i], b = values[i + 1];
            if (a >= 0 && a < b && a < count && b < count + walls) { continue; }
            return accept::Refusal{
                static_cast<std::int64_t>(i), fmt::format("{} and {}", a, b),
                fmt::format("one of 0 to {}, and a later one up to {}", count - 1, count + walls - 1)};
        }
        return {};
    };
}

void read_contacts(const h5::File& file, std::size_t rocks, BedContacts& contacts)
{
    const std::size_t count = rows_of(file, "/contacts/stiffness");
    const auto        read  = [&](const char* name, int width, const auto& accepted)
    { return read_rows<double>(file, fmt::format("/contacts/{}", name), width, count, accepted); };
    contacts.pair              = read_rows<std::int32_t>(file, "/contacts/pair", 2, count, pairs_of(rocks));
    contacts.tangential        = read("tangential", 3, accept::finite());
    contacts.normal            = read("normal", 3, accept::finite());
    contacts.torsion           = read("torsion", 1, accept::finite());
    contacts.stiffness         = read("stiffness", 1, accept::not_negative());
    contacts.twist_stiffness   = read("twist_stiffness", 1, accept::not_negative());
    contacts.place             = read("place", 3, accept::finite());
    contacts.rolling           = read("rolling", 3, accept::finite());
    contacts.rolling_stiffness = read("rolling_stiffness", 1, accept::not_negative());
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
    require_regular(path);
    run_in_child(path, [&] { return describe_here(path).substr(0, 0); });
    const h5::File file = h5::File::open_received(path);
    if (h5::read_text_attribute(file, "/", "format") != format_name) { refuse(path, "it has another format"); }
    BedFile bed;
    bed.kinds = read_kinds(file);
    read_rocks(file, bed);
    read_contacts(file, bed.size(), bed.contacts);
    bed.points = read_points(file);
    return bed;
}

} // namespace tread::io
