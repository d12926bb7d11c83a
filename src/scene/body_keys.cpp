#include "scene/keys.hpp"
#include "scene/ranges.hpp"

namespace tread::scene
{
namespace
{

constexpr const char* on_surface_word = "on surface";
constexpr const char* accepted        = "[x, y, z], each a number, or [x, y, \"on surface\"]";

bool is_on_surface(const Node& height)
{
    const auto* text = std::get_if<std::string>(&height.value);
    if (text == nullptr) { return false; }
    if (*text != on_surface_word) { throw BadValue{fmt::format("\"{}\" is no height", *text)}; }
    return true;
}

void read_position(const Node& node, Body& body)
{
    const NodeArray& items = read_array(node, 3);
    body.on_surface        = is_on_surface(items[2]);
    const double x = read_number(items[0], coordinate()), y = read_number(items[1], coordinate());
    body.position = {x, y, body.on_surface ? 0.0 : read_number(items[2], coordinate())};
}

std::string write_position(const Body& body)
{
    const auto height = body.on_surface ? write_string(on_surface_word) : write_number(body.position[2]);
    return fmt::format("[{}, {}, {}]", write_number(body.position[0]), write_number(body.position[1]), height);
}

Key<Body> position_key()
{
    const KeyText text{
        "position",
        "m",
        "required",
        accepted,
        "Of the centre of mass; inside the domain. \"on surface\": as low as the sand and the rocks under "
        "the body let it, and `gap` above them.",
        ""};
    auto read = [=](const Node& node, const std::string& table, Body& body, Problems& problems)
    {
        try
        {
            read_position(node, body);
        }
        catch (const BadValue& bad)
        {
            problems.push_back({node.where, table, text.name, bad.what, accepted_with_unit(text)});
        }
    };
    return {text, Presence::required, [](const Body&) { return true; }, read, write_position, {}};
}

template<class M>
Key<Body> orientation_key(KeyText text, M Orientation::*member, const Value<M>& value)
{
    const auto access = [member](auto& body) -> auto& { return body.orientation.*member; };
    return make_key<Body>(Presence::optional, std::move(text), access, value);
}

} // namespace

Keys<Body> body_keys()
{
    const Range       turn   = between(-360, 360);
    const std::string one_of = "exactly one of density, mass, load";
    return {
        required("name", "", &Body::name, name(), "Unique among bodies."),
        required("shape", "", &Body::shape, name(),
                 fmt::format("The name of a [[shape]], or a built-in wheel: {}.", fmt::join(builtin_wheels, ", "))),
        required("material", "", &Body::material, name(), "The name of an elastic or rigid [[material]]."),
        optional("diameter", "m", &Body::diameter, number_or("", length()),
                 "Of the sphere of equal volume: scales the shape. Required for generated rocks and spheres.",
                 "the shape's own size"),
        optional("density", "kg/m3", &Body::density, number_or("", density()), "Of the shape's solid volume.", one_of),
        optional("mass", "kg", &Body::mass, number_or("", mass()), "Spread evenly over the shape's volume.", one_of),
        optional("load", "N", &Body::load, number_or("", force()), "Weight under the scene's gravity.", one_of),
        position_key(),
        orientation_key({"axis", "", "no rotation", "",
                         "Axis in the world's frame about which the body is turned from its shape's axes; with "
                         "`angle_deg`. docs/phases.md#orientation.",
                         ""},
                        &Orientation::axis, direction_given()),
        orientation_key({"angle_deg", "deg", "no rotation", "", "Angle about `axis`, right-handed.", ""},
                        &Orientation::angle_deg, number_or("", turn)),
        orientation_key({"rows", "", "no rotation", "",
                         "Rows of the rotation R from the shape's axes to the world's, x_world = R x_shape; instead of "
                         "`axis`.",
                         ""},
                        &Orientation::rows, rotation_given()),
        orientation_key(
            {"yaw_deg", "deg", "no rotation", "",
             "Steering angle, about the vertical: positive turns the heading from +x towards +y, to the left. "
             "Instead of `axis` and `rows`.",
             ""},
            &Orientation::yaw_deg, number_or("", turn)),
        orientation_key({"camber_deg", "deg", "no rotation", "",
                         "Inclination about the heading: positive leans the top to the right of the heading. With "
                         "`yaw_deg` or alone.",
                         ""},
                        &Orientation::camber_deg, number_or("", between(-90, 90))),
        optional("gap", "m", &Body::gap, number(length_or_none()), "Left between the body and what lies under it.")
            .when("position = [x, y, \"on surface\"]", [](const Body& body) { return body.on_surface; }),
        optional("velocity", "m/s", &Body::velocity, vector3(velocity()), "When the body is first released."),
        optional("rolling_radius", "m", &Body::rolling_radius, number_or("auto", length()),
                 "Radius r of the slip ratio 1 - v_x/(omega r). \"auto\": over the grousers."),
        optional("lock", "", &Body::lock, words_of({"x", "y", "z", "roll", "pitch", "yaw"}),
                 "Degrees of freedom in the world's axes that are held fixed."),
    };
}

} // namespace tread::scene
