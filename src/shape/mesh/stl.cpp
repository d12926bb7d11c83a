#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/mesh/mesh_reader.hpp"
#include "shape/mesh/triangle.hpp"

// Binary STL: 80 bytes of header, uint32 count, then 50 bytes per triangle: float32 normal and three corners, uint16;
// all little-endian. The header may begin with "solid", so only the size distinguishes binary from text.
namespace tread::shape
{
namespace
{

static_assert(std::endian::native == std::endian::little, "STL bytes are copied as they are");

constexpr std::size_t header_size = 84;
constexpr std::size_t record_size = 50;

template<class T>
T value_at(std::string_view bytes, std::size_t at)
{
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

std::uint64_t size_for(std::uint32_t triangles) { return header_size + std::uint64_t{record_size} * triangles; }

void append_triangle(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 3>& corners)
{
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
}

TriangleMesh read_binary(std::string_view bytes, const std::string& path, std::uint32_t count)
{
    constexpr std::uint32_t most_triangles = 500'000'000; // keeps 3 x triangles within int32
    if (count > most_triangles)
    {
        throw InputError(fmt::format("{}: {} triangles; at most {} are accepted", path, count, most_triangles));
    }
    TriangleMesh mesh;
    mesh.vertices.reserve(std::size_t{3} * count);
    mesh.triangles.reserve(count);
    for (std::uint32_t t = 0; t < count; ++t)
    {
        const std::size_t              at = header_size + record_size * t + 3 * sizeof(float);
        std::array<Eigen::Vector3d, 3> corners;
        for (std::size_t i = 0; i < 9; ++i)
        {
            const auto value = value_at<float>(bytes, at + i * sizeof(float));
            if (!std::isfinite(value))
            {
                throw InputError(fmt::format("{}: triangle {}: coordinate {} is not finite", path, t, value));
            }
            corners[i / 3][static_cast<Eigen::Index>(i % 3)] = static_cast<double>(value);
        }
        append_triangle(mesh, corners);
    }
    return mesh;
}

std::string take_keyword(std::string_view& line)
{
    std::string word(take_word(line));
    for (char& letter : word) { letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter))); }
    return word;
}

void append_facet(TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& corners, const LineReader& reader)
{
    if (corners.size() != 3) { reader.fail(fmt::format("a facet has {} vertices; it must have 3", corners.size())); }
    append_triangle(mesh, {corners[0], corners[1], corners[2]});
}

TriangleMesh read_text(std::string_view text, const std::string& path)
{
    TriangleMesh                 mesh;
    LineReader                   reader{text, path};
    std::vector<Eigen::Vector3d> corners;
    bool                         ended = false;
    while (auto line = reader.next())
    {
        const std::string word = take_keyword(*line);
        if (word == "vertex") { corners.push_back(take_vector(*line, reader)); }
        else if (word == "endfacet")
        {
            append_facet(mesh, corners, reader);
            corners.clear();
        }
        else if (word == "facet" && !corners.empty()) { reader.fail("the facet before has no endfacet"); }
        else if (word == "endsolid" || word == "solid") { ended = word == "endsolid"; }
        else if (!word.empty() && word != "facet" && word != "outer" && word != "endloop")
        {
            reader.fail(fmt::format("'{}' is no keyword of a text STL", word));
        }
    }
    if (!ended || !corners.empty()) { reader.fail("the file is truncated: endsolid is missing"); }
    return mesh;
}

bool begins_with_solid(std::string_view bytes)
{
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    std::string_view head = bytes.substr(0, 5);
    return take_keyword(head) == "solid";
}

[[noreturn]] void fail_binary(std::string_view bytes, const std::string& path)
{
    if (bytes.size() < header_size)
    {
        throw InputError(
            fmt::format("{}: {} bytes are too few for an STL file (at least {})", path, bytes.size(), header_size));
    }
    const auto          count   = value_at<std::uint32_t>(bytes, 80);
    const std::uint32_t swapped = __builtin_bswap32(count);
    if (size_for(swapped) == bytes.size())
    {
        throw InputError(
            fmt::format("{}: the STL file is big-endian ({} triangles); binary STL is little-endian", path, swapped));
    }
    throw InputError(fmt::format("{}: neither a text STL (no 'solid') nor a whole binary one: its header promises {} "
                                 "triangles, which are {} bytes, but the file has {}",
                                 path, count, size_for(count), bytes.size()));
}

template<class T>
void write_value(std::ostream& file, T value)
{
    file.write(reinterpret_cast<const char*>(&value), sizeof(T));
}

void write_vector(std::ostream& file, const Eigen::Vector3d& vector)
{
    for (Eigen::Index i = 0; i < 3; ++i) { write_value(file, static_cast<float>(vector[i])); }
}

} // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& path)
{
    if (bytes.size() >= header_size)
    {
        const auto count = value_at<std::uint32_t>(bytes, 80);
        if (size_for(count) == bytes.size()) { return read_binary(bytes, path, count); }
    }
    if (begins_with_solid(bytes) && bytes.find('\0') == std::string_view::npos) { return read_text(bytes, path); }
    fail_binary(bytes, path);
}

void write_stl(const TriangleMesh& mesh, const std::string& path)
{
    std::ofstream file(path, std::ios::binary);
    std::string   header = "binary STL, metres";
    header.resize(80, ' ');
    file << header;
    write_value(file, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        write_vector(file, area_vector(mesh, t).normalized());
        for (std::size_t c = 0; c < 3; ++c) { write_vector(file, corner(mesh, t, c)); }
        write_value(file, std::uint16_t{0});
    }
    file.close();
    if (!file) { throw EnvironmentError(fmt::format("{}: the mesh cannot be written", path)); }
}

} // namespace tread::shape
