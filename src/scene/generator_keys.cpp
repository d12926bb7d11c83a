#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/spellings.hpp"

// Keys of `[[shape]] generate`.
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

Keys<BoxGenerator> box_keys()
{
    return {
        required("size", "m", &BoxGenerator::size, vector3(length()), "Edge lengths; the origin is in the middle.")};
}

Keys<PlateGenerator> plate_keys()
{
    const std::string one_of = "exactly one of radius, size";
    return {
        optional("radius", "m", &PlateGenerator::radius, number_or("", length()), "Of a disc about z.", one_of),
        optional("size", "m", &PlateGenerator::size, vector2_given(length()), "Edge lengths of a rectangle.", one_of),
        required("thickness", "m", &PlateGenerator::thickness, number(length()),
                 "Along z; the origin is in the middle."),
    };
}

Keys<CylinderGenerator> cylinder_keys()
{
    return {
        required("radius", "m", &CylinderGenerator::radius, number(length()), "Of a solid cylinder about z."),
        required("length", "m", &CylinderGenerator::length, number(length()), "Along z; the origin is in the middle."),
    };
}

Keys<ConeGenerator> cone_keys()
{
    return {
        optional("apex_angle_deg", "deg", &ConeGenerator::apex_angle_deg, number(between(5, 170)),
                 "Full angle at the tip, which points down and is the origin. 30 as in ASAE S313.3."),
        required("base_radius", "m", &ConeGenerator::base_radius, number(length()),
                 "ASAE S313.3: 0.010135 in soft soil, 0.006415 in hard soil."),
        optional("shaft_radius", "m", &ConeGenerator::shaft_radius, number(length_or_none()),
                 "Of the shaft that goes up from the base; 0 is none. ASAE S313.3: 0.00794 and 0.004765."),
        optional("shaft_length", "m", &ConeGenerator::shaft_length, number(length_or_none()),
                 "Of the shaft above the base; with `shaft_radius` alone."),
    };
}

Keys<RingGenerator> ring_keys()
{
    const auto has_vanes = [](const RingGenerator& ring) { return ring.vanes > 0; };
    return {
        required("inner_radius", "m", &RingGenerator::inner_radius, number(length()), "Of an annulus about z."),
        required("outer_radius", "m", &RingGenerator::outer_radius, number(length()), "Of the annulus and its vanes."),
        required("height", "m", &RingGenerator::height, number(length()),
                 "Of the annulus, in whose middle the origin is; vanes come on top of it."),
        optional("vanes", "", &RingGenerator::vanes, integer<int>(0, 1000),
                 "Radial vanes (grousers) on the lower face, from the inner to the outer radius."),
        required("vane_height", "m", &RingGenerator::vane_height, number(length()), "Downwards from the lower face.")
            .when("`vanes` over 0", has_vanes),
        required("vane_thickness", "m", &RingGenerator::vane_thickness, number(length()), "Across a vane.")
            .when("`vanes` over 0", has_vanes),
    };
}

Keys<TubeGenerator> tube_keys()
{
    return {
        required("radius", "m", &TubeGenerator::radius, number(length()), "Outer radius of a hollow cylinder about z."),
        required("wall_thickness", "m", &TubeGenerator::wall_thickness, number(length()), "Inwards from the radius."),
        required("length", "m", &TubeGenerator::length, number(length()),
                 "Along z, both ends open; the origin is in the middle."),
    };
}

Keys<FrameGenerator> frame_keys()
{
    return {
        required("inner_size", "m", &FrameGenerator::inner_size, vector2(length()),
                 "Of the rectangle that four walls enclose; the middle of the whole is the origin."),
        required("height", "m", &FrameGenerator::height, number(length()), "Over all."),
        required("wall_thickness", "m", &FrameGenerator::wall_thickness, number(length()), "Of each wall, outwards."),
        optional("floor_thickness", "m", &FrameGenerator::floor_thickness, number(length_or_none()),
                 "Of a floor, which makes the frame a tray; 0: open below."),
    };
}

/// Calls visit(kind, keys) for each generator: the words of `kind` and the keys of each.
template<class Visit>
void for_each_generator(Visit&& visit)
{
    visit("rock", rock_keys());
    visit("sphere", sphere_keys());
    visit("wheel", wheel_keys());
    visit("box", box_keys());
    visit("plate", plate_keys());
    visit("cylinder", cylinder_keys());
    visit("cone", cone_keys());
    visit("ring", ring_keys());
    visit("tube", tube_keys());
    visit("frame", frame_keys());
}

std::vector<std::string> generator_kinds()
{
    std::vector<std::string> kinds;
    for_each_generator([&](const std::string& kind, const auto&) { kinds.push_back(kind); });
    return kinds;
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

} // namespace

Key<Shape> generate_key()
{
    KeyText text{"generate",
                 "",
                 "or `file`, `assemble`",
                 "table with kind = " + list_words(generator_kinds()),
                 "Makes the shape; `kind` says how. Rocks and spheres have the volume of a sphere of diameter 1 m, and "
                 "[[rocks]] scales them to its `diameter`.",
                 ""};
    return {text,           Presence::optional, [](const Shape&) { return true; },
            read_generator, write_generator,    describe_generators()};
}

} // namespace tread::scene
