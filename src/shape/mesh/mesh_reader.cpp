#include "shape/mesh/mesh_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <unordered_map>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "shape/mesh/triple_hash.hpp"

namespace tread::shape
{
namespace
{

bool is_blank(char letter)
{
    return letter == ' ' || letter == '\t' || letter == '\r' || letter == '\v' || letter == '\f';
}

double take_number(std::string_view& line, const LineReader& reader)
{
    const std::string_view word   = take_word(line);
    std::string_view       digits = word;
    if (!digits.empty() && digits.front() == '+') { digits.remove_prefix(1); }
    double     value = 0;
    const auto end   = digits.data() + digits.size();
    const auto got   = std::from_chars(digits.data(), end, value);
    if (got.ec != std::errc() || got.ptr != end) { reader.fail(fmt::format("'{}' is not a coordinate", word)); }
    if (!std::isfinite(value)) { reader.fail(fmt::format("coordinate '{}' is not finite", word)); }
    return value;
}

std::string read_bytes(const std::string& path)
{
    std::error_code error;
    const auto      size = std::filesystem::file_size(path, error);
    if (error) { throw InputError(fmt::format("{}: the mesh cannot be read: {}", path, error.message())); }
    constexpr double in_memory = 6; // bytes of vertices, triangles and their spatial hash per byte of the file
    require_host_memory(
        {in_memory * static_cast<double>(size), fmt::format("{}: its triangles", path), "a coarser mesh"});
    if (size == 0) { throw InputError(fmt::format("{}: the mesh file is empty", path)); }
    std::string   bytes(size, ' ');
    std::ifstream file(path, std::ios::binary);
    if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    {
        throw InputError(fmt::format("{}: the mesh cannot be read", path));
    }
    return bytes;
}

/// Key of a position. Adding 0.0 turns -0.0 into 0.0.
std::array<double, 3> key_of(const Eigen::Vector3d& place)
{
    return {place.x() + 0.0, place.y() + 0.0, place.z() + 0.0};
}

std::string lower_extension(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& letter : extension) { letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter))); }
    return extension;
}

} // namespace

std::optional<std::string_view> LineReader::next()
{
    if (text.empty()) { return std::nullopt; }
    ++number;
    const std::size_t      end  = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
}

void LineReader::fail(const std::string& message) const
{
    throw InputError(fmt::format("{}:{}: {}", path, number, message));
}

std::string_view take_word(std::string_view& line)
{
    const auto first = std::find_if_not(line.begin(), line.end(), is_blank);
    const auto last  = std::find_if(first, line.end(), is_blank);
    line             = {last, line.end()};
    return {first, last};
}

Eigen::Vector3d take_vector(std::string_view& line, const LineReader& reader)
{
    const double x = take_number(line, reader);
    const double y = take_number(line, reader);
    const double z = take_number(line, reader);
    return {x, y, z};
}

TriangleMesh weld(const TriangleMesh& mesh)
{
    std::unordered_map<std::array<double, 3>, std::int32_t, TripleHash> known;
    TriangleMesh                                                        welded;
    known.reserve(std::min(mesh.vertices.size(), mesh.triangles.size()));
    welded.triangles.reserve(mesh.triangles.size());
    for (const auto& corners : mesh.triangles)
    {
        std::array<std::int32_t, 3> triangle{};
        for (std::size_t c = 0; c < 3; ++c)
        {
            const Eigen::Vector3d& place = mesh.vertices[static_cast<std::size_t>(corners[c])];
            const auto             next  = static_cast<std::int32_t>(welded.vertices.size());
            const auto [entry, inserted] = known.try_emplace(key_of(place), next);
            if (inserted) { welded.vertices.push_back(place); }
            triangle[c] = entry->second;
        }
        welded.triangles.push_back(triangle);
    }
    return welded;
}

void require_sane_size(const TriangleMesh& mesh, const std::string& path)
{
    constexpr double most = 1e9; // m
    for (const Eigen::Vector3d& vertex : mesh.vertices)
    {
        const double coordinate = vertex.cwiseAbs().maxCoeff();
        if (coordinate <= most) { continue; }
        throw InputError(fmt::format("{}: a coordinate is {:.6g} m; accepted are up to {:.0g} m: is `unit` right?",
                                     path, coordinate, most));
    }
}

TriangleMesh read_mesh(const std::string& path, double unit)
{
    const std::string extension = lower_extension(path);
    if (extension != ".stl" && extension != ".obj")
    {
        throw InputError(fmt::format("{}: unknown mesh format '{}'; accepted are .stl and .obj", path, extension));
    }
    const std::string bytes = read_bytes(path);
    TriangleMesh      mesh  = weld(extension == ".stl" ? read_stl(bytes, path) : read_obj(bytes, path));
    if (mesh.triangles.empty()) { throw InputError(fmt::format("{}: the mesh has no triangles", path)); }
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex *= unit; }
    require_sane_size(mesh, path);
    return mesh;
}

} // namespace tread::shape
