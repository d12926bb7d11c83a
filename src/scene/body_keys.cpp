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

} // namespace

Key<Body> body_position_key()
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

} // namespace tread::scene
