#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "shape/mesh/mesh_reader.hpp"

// Wavefront OBJ: "v x y z" and "f a b c ...", where an entry of f is a, a/b, a//c or a/b/c; indices count from 1, or
// backwards from the last vertex if negative. Other lines (normals, textures, groups, materials) carry no geometry.
namespace tread::shape
{
namespace
{

std::int32_t vertex_index(std::string_view entry, std::size_t vertices, const LineReader& reader)
{
    const std::string_view digits = entry.substr(0, entry.find('/'));
    std::int64_t           index  = 0;
    const auto             end    = digits.data() + digits.size();
    const auto             got    = std::from_chars(digits.data(), end, index);
    if (got.ec != std::errc() || got.ptr != end) { reader.fail(fmt::format("'{}' is not a vertex index", entry)); }
    const auto         count = static_cast<std::int64_t>(vertices);
    const std::int64_t at    = index < 0 ? count + index : index - 1;
    if (at < 0 || at >= count)
    {
        reader.fail(fmt::format("vertex index {} is out of range: {} vertices stand before this line", index, count));
    }
    return static_cast<std::int32_t>(at);
}

/// Splits polygons into fans about their first corner.
void append_face(TriangleMesh& mesh, std::string_view line, const LineReader& reader)
{
    std::vector<std::int32_t> corners;
    for (auto entry = take_word(line); !entry.empty(); entry = take_word(line))
    {
        corners.push_back(vertex_index(entry, mesh.vertices.size(), reader));
    }
    if (corners.size() < 3) { reader.fail(fmt::format("a face has {} vertices; it needs 3", corners.size())); }
    for (std::size_t i = 2; i < corners.size(); ++i)
    {
        mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
}

} // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& path)
{
    TriangleMesh mesh;
    LineReader   reader{bytes, path};
    while (auto line = reader.next())
    {
        const std::string_view keyword = take_word(*line);
        if (keyword == "v") { mesh.vertices.push_back(take_vector(*line, reader)); }
        else if (keyword == "f") { append_face(mesh, line->substr(0, line->find('#')), reader); }
    }
    return mesh;
}

} // namespace tread::shape
