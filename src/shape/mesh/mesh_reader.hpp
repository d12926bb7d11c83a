#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh/mesh.hpp"

// Shared by the mesh readers. Independent of the locale.
namespace tread::shape
{

/// Iterates over the lines of a text and counts them.
struct LineReader
{
    std::string_view text;
    std::string_view path;
    std::int64_t     number = 0;

    /// Next line without its line break; empty at the end of the text.
    std::optional<std::string_view> next();

    /// Throws InputError "path:line: message".
    [[noreturn]] void fail(const std::string& message) const;
};

/// Removes and returns the first word of the line; empty at its end.
std::string_view take_word(std::string_view& line);

/// Removes and returns three finite numbers from the line, or fails.
Eigen::Vector3d take_vector(std::string_view& line, const LineReader& reader);

TriangleMesh read_stl(std::string_view bytes, const std::string& path);
TriangleMesh read_obj(std::string_view bytes, const std::string& path);

/// Merges equal corners into one vertex and removes unused vertices; keeps the order of first use.
TriangleMesh weld(const TriangleMesh& mesh);

/// InputError unless all coordinates are at most 1e9 m: beyond, areas and volumes would overflow.
void require_sane_size(const TriangleMesh& mesh, const std::string& path);

} // namespace tread::shape
