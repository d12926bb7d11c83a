#include "shape/hull_depth.hpp"

#include <algorithm>
#include <limits>

#include "shape/mesh/convex_hull.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{

double hull_depth(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& places)
{
    const TriangleMesh hull = convex_hull(mesh.vertices);

    std::vector<Eigen::Vector3d> normals;
    std::vector<double>          offsets;
    normals.reserve(hull.triangles.size());
    offsets.reserve(hull.triangles.size());
    for (std::size_t t = 0; t < hull.triangles.size(); ++t)
    {
        const Eigen::Vector3d area = area_vector(hull, t);
        if (!(area.squaredNorm() > 0)) { continue; }
        normals.push_back(area.normalized());
        offsets.push_back(normals.back().dot(corner(hull, t, 0)));
    }
    double deepest = 0;
    for (const Eigen::Vector3d& place : places)
    {
        double depth = std::numeric_limits<double>::infinity();
        // A point no deeper than the deepest one so far below some face need not be tested against the others.
        for (std::size_t t = 0; t < normals.size() && depth > deepest; ++t)
        {
            depth = std::min(depth, offsets[t] - normals[t].dot(place));
        }
        deepest = std::max(deepest, depth);
    }
    return deepest;
}

} // namespace tread::shape
