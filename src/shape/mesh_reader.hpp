#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape/mesh.hpp"

// What the mesh readers share. None of it depends on the locale.
namespace tread::shape
{

/// Steps through the lines of a text and knows where it is.
struct LineReader
{
    std::string_view text;
    std::string_view path;
    std::int64_t     number = 0;

    /// The next line without its end; nothing at the end of the text.
    std::optional<std::string_view> next();

    /// Throws InputError "path:line: message".
    [[noreturn]] void fail(const std::string& message) const;
};

/// Takes the first word off the line; empty at its end.
std::string_view take_word(std::string_view& line);

/// Takes three finite numbers off the line, or fails.
Eigen::Vector3d take_vector(std::string_view& line, const LineReader& reader);

TriangleMesh read_stl(std::string_view bytes, const std::string& path);
TriangleMesh read_obj(std::string_view bytes, const std::string& path);

/// Makes equal corners one vertex and drops vertices that no triangle uses; the order of first use stays.
TriangleMesh weld(const TriangleMesh& mesh);

/// InputError unless all coordinates are at most 1e9 m: beyond, areas and volumes would leave the range of numbers.
void require_sane_size(const TriangleMesh& mesh, const std::string& path);

} // namespace tread::shape
