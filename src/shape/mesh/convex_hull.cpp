#include "shape/mesh/convex_hull.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <fmt/format.h>

extern "C"
{
#include <libqhull_r/libqhull_r.h>
}

#include "base/errors.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

/// Qhull's memory for one hull, and a file that discards its messages.
struct Workspace
{
    Workspace()
        : complaints(std::tmpfile(), &std::fclose)
    {
        qh_zero(&context, complaints.get());
    }
    Workspace(const Workspace&)            = delete;
    Workspace& operator=(const Workspace&) = delete;
    ~Workspace()
    {
        qh_freeqhull(&context, !qh_ALL);
        int long_blocks, long_bytes;
        qh_memfreeshort(&context, &long_blocks, &long_bytes);
    }

    std::unique_ptr<std::FILE, int (*)(std::FILE*)> complaints;
    qhT                                             context{};
};

/// Orients triangles counter-clockwise seen from outside, in whatever order Qhull holds the corners.
void orient(TriangleMesh& hull, const double* outwards)
{
    if (area_vector(hull, hull.triangles.size() - 1).dot(Eigen::Map<const Eigen::Vector3d>(outwards)) < 0)
    {
        std::swap(hull.triangles.back()[1], hull.triangles.back()[2]);
    }
}

} // namespace

TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points)
{
    std::vector<double> coordinates;
    coordinates.reserve(3 * points.size());
    for (const Eigen::Vector3d& point : points)
    {
        coordinates.insert(coordinates.end(), point.data(), point.data() + 3);
    }

    Workspace   workspace;
    qhT* const  qh      = &workspace.context; // the name that Qhull's macros expect
    std::string command = "qhull Qt";
    const int failure = qh_new_qhull(qh, 3, static_cast<int>(points.size()), coordinates.data(), False, command.data(),
                                     nullptr, workspace.complaints.get());
    if (failure == qh_ERRmem) { throw std::bad_alloc(); }
    if (failure != 0) { throw InputError(fmt::format("no convex hull: the {} points lie in a plane", points.size())); }

    TriangleMesh              hull;
    std::vector<std::int32_t> place(points.size(), -1);
    facetT*                   facet;
    FORALLfacets
    {
        std::size_t side = 0;
        vertexT *   vertex, **vertexp;
        hull.triangles.emplace_back();
        FOREACHvertex_(facet->vertices)
        {
            std::int32_t& index = place[static_cast<std::size_t>(qh_pointid(qh, vertex->point))];
            if (index < 0)
            {
                index = static_cast<std::int32_t>(hull.vertices.size());
                hull.vertices.emplace_back(Eigen::Map<const Eigen::Vector3d>(vertex->point));
            }
            hull.triangles.back().at(side++) = index;
        }
        orient(hull, facet->normal);
    }
    return hull;
}

} // namespace tread::shape
