#include "shape/mesh/refinement.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace tread::shape
{
namespace
{

/// Bisects the longest side of each triangle until none is longer than `longest`. A long side is bisected in both of
/// its triangles, in any order, so that the mesh stays closed without adjacency data.
class Refinement
{
public:
    Refinement(const TriangleMesh& mesh, double longest)
        : result{mesh.vertices, {}}
        , longest_squared_(longest * longest)
    {
        for (const auto& triangle : mesh.triangles) { refine(triangle); }
    }

    TriangleMesh result;

private:
    double squared_length(std::int32_t a, std::int32_t b) const
    {
        return (result.vertices[static_cast<std::size_t>(a)] - result.vertices[static_cast<std::size_t>(b)])
            .squaredNorm();
    }

    static std::uint64_t edge_key(std::int32_t a, std::int32_t b)
    {
        return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
    }

    std::int32_t middle(std::int32_t a, std::int32_t b)
    {
        const auto next              = static_cast<std::int32_t>(result.vertices.size());
        const auto [entry, inserted] = middles_.try_emplace(edge_key(a, b), next);
        if (inserted)
        {
            const Eigen::Vector3d place =
                0.5 * (result.vertices[static_cast<std::size_t>(a)] + result.vertices[static_cast<std::size_t>(b)]);
            result.vertices.push_back(place);
        }
        return entry->second;
    }

    void refine(const std::array<std::int32_t, 3>& triangle)
    {
        std::size_t side   = 0;
        double      length = 0;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const double squared = squared_length(triangle[s], triangle[(s + 1) % 3]);
            if (squared > length)
            {
                length = squared;
                side   = s;
            }
        }
        if (length <= longest_squared_)
        {
            result.triangles.push_back(triangle);
            return;
        }
        const std::int32_t from = triangle[side], to = triangle[(side + 1) % 3], apex = triangle[(side + 2) % 3];
        const std::int32_t half = middle(from, to);
        refine({from, half, apex});
        refine({half, to, apex});
    }

    double                                          longest_squared_;
    std::unordered_map<std::uint64_t, std::int32_t> middles_;
};

} // namespace

TriangleMesh refined(const TriangleMesh& mesh, double longest) { return Refinement(mesh, longest).result; }

} // namespace tread::shape
