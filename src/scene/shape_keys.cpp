#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

Keys<RockGenerator> rock_keys()
{
    return {
        optional("seed", "", &RockGenerator::seed, integer<std::uint64_t>(0), "Of the random shape."),
        optional("aspect", "", &RockGenerator::aspect, number(between(0.2, 1)), "Smallest over largest extent."),
        optional("elongation", "", &RockGenerator::elongation, number_or("auto", between(0.2, 1)),
                 "Middle over largest extent; \"auto\" = (1 + aspect)/2."),
        optional("sphericity", "", &RockGenerator::sphericity, number(between(0.3, 1)),
                 "Surface of the sphere of equal volume over the rock's."),
        optional("solidity", "", &RockGenerator::solidity, number(between(0.5, 1)),
                 "Volume over that of the convex hull."),
        optional("nodes", "", &RockGenerator::nodes, integer<int>(20, 20000),
                 "Surface nodes, evenly spread, on sharp edges too."),
        optional("variants", "", &RockGenerator::variants, integer<int>(1, 1000),
                 "A family of that many rocks, all of this form; a [[rocks]] table of the shape draws from all."),
    };
}

Keys<SphereGenerator> sphere_keys()
{
    return {optional("nodes", "", &SphereGenerator::nodes, integer_of({42, 162, 642, 2562}), "Surface nodes.")};
}

Keys<WheelGenerator> wheel_keys()
{
    return {
        optional("radius", "m", &WheelGenerator::radius, number(length()), "Over the grousers."),
        optional("width", "m", &WheelGenerator::width, number(length()), "Along the axle, which is the mesh's y axis."),
        optional("wall_thickness", "m", &WheelGenerator::wall_thickness, number(length()), "Of the drum."),
        optional("crown", "m", &WheelGenerator::crown, number(length_or_none()),
                 "By how much the drum's radius is smaller at its edges than in the middle; parabolic between."),
        optional("grousers", "", &WheelGenerator::grousers, integer<int>(0, 1000), "How many."),
        optional("grouser_height", "m", &WheelGenerator::grouser_height, number(length_or_none()), "Above the drum."),
        optional("grouser_width", "m", &WheelGenerator::grouser_width, number(length()), "Along the circumference."),
        optional("grouser_shape", "", &WheelGenerator::grouser_shape, word<GrouserShape>(),
                 "Seen from outside: along the axle, a V, or a parabola."),
        optional("grouser_sweep_deg", "deg", &WheelGenerator::grouser_sweep_deg, number(between(-60, 60)),
                 "From a grouser's middle to its ends, about the axle; positive, and rolling towards +x, the ends meet "
                 "the ground first. Needed by chevron and curved grousers, 0 for straight ones."),
        optional("rim_height", "m", &WheelGenerator::rim_height, number(length_or_none()),
                 "Of the flanges inside both edges of the drum; 0 is none."),
        optional("rim_thickness", "m", &WheelGenerator::rim_thickness, number(length_or_none()),
                 "Of the flanges, along the axle; with `rim_height` alone."),
        optional("hub_radius", "m", &WheelGenerator::hub_radius, number(length_or_none()),
                 "Of a solid hub in the middle, carried by a disc; 0 is an open rim."),
        optional("hub_width", "m", &WheelGenerator::hub_width, number(length_or_none()),
                 "Of the hub, along the axle; with `hub_radius` alone."),
        optional("web_thickness", "m", &WheelGenerator::web_thickness, number(length_or_none()),
                 "Of the disc from hub to drum; with `hub_radius` alone."),
    };
}

/// Calls visit(kind, keys) for each generator: the words of `kind` and the keys of each.
template<class Visit>
void for_each_generator(Visit&& visit)
{
    visit("rock", rock_keys());
    visit("sphere", sphere_keys());
    visit("wheel", wheel_keys());
}

std::vector<std::string> generator_kinds()
{
    std::vector<std::string> kinds;
    for_each_generator([&](const std::string& kind, const auto&) { kinds.push_back(kind); });
    return kinds;
}

/// Generator that is created for a table with keys of type Keys<Generator>.
template<class Generator>
Generator made_by(const Keys<Generator>&)
{
    return {};
}

/// Reads the word of `kind`; empty, with a problem reported, if it is missing or unknown.
std::optional<std::string> read_kind(const Node& node, const std::string& table, Problems& problems)
{
    const auto  kinds = generator_kinds();
    const Node* kind  = find(node, "kind");
    if (kind == nullptr)
    {
        problems.push_back({node.where, table, "kind", "missing", list_words(kinds)});
        return std::nullopt;
    }
    try
    {
        return kinds[read_word(*kind, kinds)];
    }
    catch (const BadValue& bad)
    {
        problems.push_back({kind->where, table, "kind", bad.what, list_words(kinds)});
        return std::nullopt;
    }
}

void read_generator(const Node& node, const std::string& table, Shape& shape, Problems& problems)
{
    const auto label = table + ".generate";
    const auto kind  = read_kind(node, label, problems);
    if (!kind) { return; }
    Node parameters = node;
    std::get<NodeTable>(parameters.value).erase("kind");
    for_each_generator(
        [&](const std::string& candidate, const auto& keys)
        {
            if (candidate != *kind) { return; }
            auto generator = made_by(keys);
            read_table(parameters, label, keys, generator, problems);
            shape.source = generator;
        });
}

std::string write_generator(const Shape& shape)
{
    std::string text;
    for_each_generator(
        [&](const std::string& kind, const auto& keys)
        {
            const auto* generator = std::get_if<decltype(made_by(keys))>(&shape.source);
            if (generator != nullptr)
            {
                text = "{ kind = \"" + kind + "\", " + write_keys(keys, *generator, ", ") + " }";
            }
        });
    return text;
}

std::vector<TableText> describe_generators()
{
    std::vector<TableText> texts;
    for_each_generator([&](const std::string& kind, const auto& keys)
                       { texts.push_back(describe("[[shape]] generate, kind = \"" + kind + "\"", "", keys)); });
    return texts;
}

bool is_file(const Shape& shape) { return std::holds_alternative<MeshFile>(shape.source); }

Key<Shape> generate_key()
{
    KeyText text{"generate",
                 "",
                 "or `file`",
                 "table with kind = " + list_words(generator_kinds()),
                 "Makes the shape; `kind` says how. Rocks and spheres have the volume of a sphere of diameter 1 m, and "
                 "[[rocks]] scales them to its `diameter`.",
                 ""};
    return {text,           Presence::optional, [](const Shape&) { return true; },
            read_generator, write_generator,    describe_generators()};
}

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

} // namespace

Keys<Shape> shape_keys()
{
    return {
        required("name", "", &Shape::name, name(), "Unique among shapes."),
        generate_key(),
        mesh_key({"file", "", "or `generate`", "", "STL or OBJ; a relative path starts at the scene file.", ""},
                 &MeshFile::path, text()),
        mesh_key({"unit", "", "", "", "Length of one unit of the file; only with `file`.", ""}, &MeshFile::unit,
                 length_unit()),
        mesh_key({"repair", "", "", "",
                  "Mends a mesh that is not watertight and says how: welds vertices, drops degenerate and duplicate "
                  "triangles, divides seams, winds triangles alike, closes small holes; what is still open is signed "
                  "by winding number. Without it such a mesh is an error. Only with `file`.",
                  ""},
                 &MeshFile::repair, boolean()),
        optional(
            "sdf_cells", "", &Shape::sdf_cells, integer_or("auto", 8, 1024),
            "Cells of the signed distance field along the longest axis of its box (1.2 times the shape's). "
            "\"auto\": 1.5 across the thinnest wall, 40 to 512; one a surface node of a rock or sphere, 40 to 64."),
        optional("node_spacing", "m", &Shape::node_spacing, number(length_or_none()),
                 "Of the surface nodes; 0 leaves it to the generator, or takes a 40th of a mesh file's extent."),
    };
}

} // namespace tread::scene
