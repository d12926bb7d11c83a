#pragma once

#include <cstdint>
#include <vector>

#include "kernels/dem/contact/ray_kern.hpp"

namespace tread::dem
{

/// Host memory of RayView.
struct RayShape
{
    RayView view() const
    {
        return {boxes.data(), static_cast<std::int32_t>(boxes.size()), triangles.data(), inward.data(), length.data()};
    }

    std::vector<RayBox>       boxes;
    std::vector<RayTriangle>  triangles;
    std::vector<Vec3<double>> inward;
    std::vector<double>       length;
};

/// Computes the length of each node's ray: half the distance from the node along its inward normal to the opposite side
/// of its own body. A node that penetrates deeper is nearer to the opposite side, which has nodes of its own. The limit
/// also keeps nodes on the flanks of a tip that is pressed into a body from reaching that body's far side.
std::vector<double> ray_lengths(const RayShape& shape, const std::vector<Vec3<double>>& nodes);

/// Makes a RayShape from a tree laid out as shape::FlatTree and from the surface nodes with their outward normals.
template<class Tree>
RayShape make_ray_shape(const Tree& tree, const std::vector<Vec3<double>>& nodes,
                        const std::vector<Vec3<double>>& normals)
{
    RayShape shape;
    shape.boxes.reserve(tree.boxes.size());
    for (const auto& box : tree.boxes)
    {
        shape.boxes.push_back(
            {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}, box.next, box.leaf});
    }
    shape.triangles.reserve(tree.triangles.size());
    for (const auto& corners : tree.triangles)
    {
        shape.triangles.push_back({corners[0], corners[1] - corners[0], corners[2] - corners[0]});
    }
    shape.inward.reserve(normals.size());
    for (const Vec3<double>& normal : normals) { shape.inward.push_back(-normal); }
    shape.length = ray_lengths(shape, nodes);
    return shape;
}

} // namespace tread::dem
