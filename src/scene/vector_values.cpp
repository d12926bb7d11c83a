#include <cmath>

#include "scene/array_values.hpp"
#include "scene/ranges.hpp"

namespace tread::scene
{
namespace
{

constexpr double least_direction    = 1e-6;
constexpr double rotation_tolerance = 1e-6; ///< of products of rows: seven digits are enough

Vector3 read_vector3(const Node& node, const Range& range)
{
    const auto values = read_each(read_array(node, 3), [&](const Node& item) { return read_number(item, range); });
    return {values[0], values[1], values[2]};
}

std::string write_vector3(const Vector3& value) { return write_array(value, write_number); }

Box read_box(const Node& node)
{
    const auto corners =
        read_each(read_array(node, 2), [](const Node& item) { return read_vector3(item, coordinate()); });
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (!(corners[0][axis] < corners[1][axis])) { throw BadValue{"the box is empty"}; }
    }
    return Box{corners[0], corners[1]};
}

std::string write_box(const Box& value)
{
    return fmt::format("[{}, {}]", write_vector3(value.low), write_vector3(value.high));
}

constexpr const char* accepted_box = "[[x, y, z], [x, y, z]], the second above the first in each component";

PlanExtent read_extent(const Node& node)
{
    const auto read_corner = [](const Node& item)
    { return read_each(read_array(item, 2), [](const Node& number) { return read_number(number, coordinate()); }); };
    const auto corners = read_each(read_array(node, 2), read_corner);
    if (!(corners[0][0] < corners[1][0] && corners[0][1] < corners[1][1])) { throw BadValue{"the extent is empty"}; }
    return {{{corners[0][0], corners[0][1]}, {corners[1][0], corners[1][1]}}};
}

Vector2 read_vector2(const Node& node, const Range& range)
{
    const auto values = read_each(read_array(node, 2), [&](const Node& item) { return read_number(item, range); });
    return {values[0], values[1]};
}

std::string write_vector2(const Vector2& value) { return write_array(value, write_number); }

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector3 read_direction(const Node& node)
{
    const Vector3 direction = read_vector3(node, coordinate());
    if (!(dot(direction, direction) > least_direction * least_direction)) { throw BadValue{"has no direction"}; }
    return direction;
}

constexpr const char* accepted_direction = "[x, y, z], longer than 1e-6; its length does not matter";

/// Refuses rows that are not those of a rotation: unit vectors, perpendicular, right-handed.
void require_rotation(const Matrix3& rows)
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        for (std::size_t j = 0; j <= i; ++j)
        {
            const double product = dot(rows[i], rows[j]);
            if (std::abs(product - (i == j ? 1.0 : 0.0)) <= rotation_tolerance) { continue; }
            throw BadValue{
                i == j ? fmt::format("row {} has a length of {:.8g}", i, std::sqrt(product))
                       : fmt::format("rows {} and {} are not perpendicular: their product is {:.3g}", j, i, product)};
        }
    }
    const Vector3 normal{rows[0][1] * rows[1][2] - rows[0][2] * rows[1][1],
                         rows[0][2] * rows[1][0] - rows[0][0] * rows[1][2],
                         rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]};
    if (dot(normal, rows[2]) < 0) { throw BadValue{"the rows are left-handed: a reflection, not a rotation"}; }
}

Matrix3 read_rotation(const Node& node)
{
    const auto rows =
        read_each(read_array(node, 3), [](const Node& item) { return read_vector3(item, between(-1.1, 1.1)); });
    const Matrix3 rotation{rows[0], rows[1], rows[2]};
    require_rotation(rotation);
    return rotation;
}

} // namespace

Value<Vector3> vector3(Range range)
{
    return {"[x, y, z], each a " + range.text(), [=](const Node& node) { return read_vector3(node, range); },
            write_vector3};
}

Value<std::optional<Vector3>> vector3_given(Range range)
{
    return {"[x, y, z], each a " + range.text(),
            [=](const Node& node) -> std::optional<Vector3> { return read_vector3(node, range); },
            [](const std::optional<Vector3>& value) { return value ? write_vector3(*value) : std::string(); }};
}

Value<std::optional<Box>> box_given()
{
    return {accepted_box, [](const Node& node) -> std::optional<Box> { return read_box(node); },
            [](const std::optional<Box>& value) { return value ? write_box(*value) : std::string(); }};
}

Value<std::vector<Box>> boxes()
{
    constexpr std::size_t most = 100; // limit, because columns of a region are cut at the faces of each box
    const auto            read = [](const Node& node)
    {
        const NodeArray& list = read_list(node);
        if (list.size() > most) { throw BadValue{fmt::format("{} boxes", list.size())}; }
        return read_each(list, read_box);
    };
    return {fmt::format("array of at most {} boxes {}", most, accepted_box), read,
            [](const std::vector<Box>& value) { return write_array(value, write_box); }};
}

Value<std::optional<PlanExtent>> extent_given()
{
    const auto write = [](const std::optional<PlanExtent>& value)
    {
        const auto corner = [](const std::array<double, 2>& at) { return write_array(at, write_number); };
        return value ? write_array(*value, corner) : std::string();
    };
    return {"[[x, y], [x, y]], the second above the first in both",
            [](const Node& node) -> std::optional<PlanExtent> { return read_extent(node); }, write};
}

Value<Vector2> vector2(Range range)
{
    return {"[x, y], each a " + range.text(), [=](const Node& node) { return read_vector2(node, range); },
            write_vector2};
}

Value<std::optional<Vector2>> vector2_given(Range range)
{
    return {"[x, y], each a " + range.text(),
            [=](const Node& node) -> std::optional<Vector2> { return read_vector2(node, range); },
            [](const std::optional<Vector2>& value) { return value ? write_vector2(*value) : std::string(); }};
}

Value<Vector3> direction() { return {accepted_direction, read_direction, write_vector3}; }

Value<std::optional<Vector3>> direction_given()
{
    return {accepted_direction, [](const Node& node) -> std::optional<Vector3> { return read_direction(node); },
            [](const std::optional<Vector3>& value) { return value ? write_vector3(*value) : std::string(); }};
}

Value<std::optional<Matrix3>> rotation_given()
{
    return {"three rows [x, y, z], perpendicular unit vectors to 1e-6, right-handed",
            [](const Node& node) -> std::optional<Matrix3> { return read_rotation(node); },
            [](const std::optional<Matrix3>& value)
            { return value ? write_array(*value, write_vector3) : std::string(); }};
}

} // namespace tread::scene
