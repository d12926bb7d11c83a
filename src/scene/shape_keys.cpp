#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

constexpr std::size_t most_assembled = 100;
constexpr const char* accepted_parts = "array of 1 to 100 tables, see [[shape]] assemble";

bool is_file(const Shape& shape) { return std::holds_alternative<MeshFile>(shape.source); }

/// `access` gives the member of a MeshFile; setting the key makes the shape a mesh file.
template<class M>
Key<Shape> mesh_key(KeyText text, M MeshFile::*member, const Value<M>& value)
{
    auto key  = make_key<MeshFile>(Presence::optional, std::move(text), member, value);
    auto read = [=](const Node& node, const std::string& table, Shape& shape, Problems& problems)
    {
        if (!is_file(shape)) { shape.source = MeshFile{}; }
        key.read(node, table, std::get<MeshFile>(shape.source), problems);
    };
    auto write = [=](const Shape& shape)
    { return is_file(shape) ? key.write(std::get<MeshFile>(shape.source)) : std::string(); };
    return {key.text, Presence::optional, [](const Shape&) { return true; }, read, write, {}};
}

Keys<AssemblyPart> part_keys()
{
    return {
        required("shape", "", &AssemblyPart::shape, name(),
                 "The name of a [[shape]] or of a built-in wheel; of a family of rocks, its first."),
        optional("at", "m", &AssemblyPart::at, vector3(coordinate()), "Of the part's origin."),
        optional("axis", "", &AssemblyPart::axis, direction(),
                 "Axis through the part's origin about which it is turned."),
        optional("angle_deg", "deg", &AssemblyPart::angle_deg, number(between(-360, 360)),
                 "About `axis`, right-handed."),
        optional("scale", "", &AssemblyPart::scale, number(between(1e-6, 1e6)),
                 "Factor of the part's size; the diameter in metres of a rock or sphere."),
    };
}

void read_parts(const Node& node, const std::string& table, Shape& shape, Problems& problems)
{
    const auto* list = std::get_if<NodeArray>(&node.value);
    if (list == nullptr || list->empty() || list->size() > most_assembled)
    {
        const auto what = list == nullptr ? "wrong type: " + kind_of(node) : fmt::format("{} parts", list->size());
        problems.push_back({node.where, table, "assemble", what, accepted_parts});
        return;
    }
    Assembly assembly{std::vector<AssemblyPart>(list->size())};
    for (std::size_t i = 0; i < list->size(); ++i)
    {
        read_table((*list)[i], fmt::format("{}.assemble.{}", table, i), part_keys(), assembly.parts[i], problems);
    }
    shape.source = assembly;
}

std::string write_parts(const Shape& shape)
{
    const auto* assembly = std::get_if<Assembly>(&shape.source);
    if (assembly == nullptr) { return {}; }
    std::string text;
    for (const AssemblyPart& part : assembly->parts)
    {
        text += (text.empty() ? "" : ", ") + write_inline(part_keys(), part);
    }
    return "[" + text + "]";
}

Key<Shape> assemble_key()
{
    KeyText text{"assemble",
                 "",
                 "or `file`, `generate`",
                 accepted_parts,
                 "Other shapes, each placed by its own origin: the shape is their union, one rigid body. "
                 "docs/shapes.md#assemblies.",
                 ""};
    return {text,       Presence::optional, [](const Shape&) { return true; },
            read_parts, write_parts,        {describe("[[shape]] assemble", "", part_keys())}};
}

} // namespace

Keys<Shape> shape_keys()
{
    return {
        required("name", "", &Shape::name, name(), "Unique among shapes."),
        generate_key(),
        assemble_key(),
        mesh_key(
            {"file", "", "or `generate`, `assemble`", "", "STL or OBJ; a relative path starts at the scene file.", ""},
            &MeshFile::path, text()),
        mesh_key({"unit", "", "", "", "Length of one unit of the file; only with `file`.", ""}, &MeshFile::unit,
                 length_unit()),
        mesh_key({"repair", "", "", "",
                  "Mends a mesh that is not watertight and says how: welds vertices, drops degenerate and duplicate "
                  "triangles, divides seams, winds triangles alike, closes small holes; what is still open is signed "
                  "by winding number. Without it such a mesh is an error. Only with `file`.",
                  ""},
                 &MeshFile::repair, boolean()),
        optional("sdf_cells", "", &Shape::sdf_cells, integer_or("auto", 8, 1024),
                 "Cells of the signed distance field along the longest axis of its box (1.2 times the shape's). "
                 "\"auto\": 1.5 across the thinnest wall, 40 to 512, of a tool or an assembly more if they lose over 2 "
                 "% of its "
                 "volume; one a surface node of a rock or sphere, 40 to 64."),
        optional(
            "node_spacing", "m", &Shape::node_spacing, number(length_or_none()),
            "Of the surface nodes; 0 leaves it to the generator, or takes a 40th of the extent of a mesh file or an "
            "assembly."),
    };
}

} // namespace tread::scene
