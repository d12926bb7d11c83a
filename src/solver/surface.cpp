#include "solver/surface.hpp"

#include <algorithm>
#include <cmath>

namespace tread::solver
{
namespace
{

void raise(SurfaceColumns& columns, std::pair<long, long> column, double height)
{
    double& top = columns[column];
    top         = std::max(top, height);
}

} // namespace

SurfaceColumns surface_columns(const std::vector<Vec3<double>>& positions, double spacing)
{
    SurfaceColumns columns;
    for (const Vec3<double>& x : positions)
    {
        raise(columns, {std::lround(x[0] / spacing), std::lround(x[1] / spacing)}, x[2]);
    }
    return columns;
}

SurfaceColumns gathered(const SurfaceColumns& columns, const Communicator& communicator)
{
    std::vector<double> rows;
    for (const auto& [column, top] : columns)
    {
        rows.insert(rows.end(), {static_cast<double>(column.first), static_cast<double>(column.second), top});
    }
    rows = communicator.gather(rows);
    SurfaceColumns all;
    for (std::size_t i = 0; i < rows.size(); i += 3)
    {
        raise(all, {static_cast<long>(rows[i]), static_cast<long>(rows[i + 1])}, rows[i + 2]);
    }
    return all;
}

double middle_height(const SurfaceColumns& columns, const std::vector<BodyRow>& bodies, double spacing)
{
    std::vector<double> heights;
    for (const auto& [column, top] : columns)
    {
        const bool under = std::any_of(bodies.begin(), bodies.end(),
                                       [&, at = column](const BodyRow& body) {
                                           return std::abs(body.position[0] - spacing * double(at.first)) <
                                                  1.2 * (body.position[2] - body.lowest);
                                       });
        if (!under) { heights.push_back(top); }
    }
    if (heights.empty())
    {
        for (const auto& [column, top] : columns) { heights.push_back(top); }
    }
    std::nth_element(heights.begin(), heights.begin() + static_cast<long>(heights.size() / 2), heights.end());
    return heights[heights.size() / 2];
}

double height_of_rocks(const World& world, const io::BodyFields& fields, const std::vector<BodyRow>& bodies)
{
    std::vector<Vec3<double>> tops;
    double                    mean_radius = 0;
    const auto                rocks       = fields.scale.size() - static_cast<std::size_t>(world.bodies.named);
    for (auto b = static_cast<std::size_t>(world.bodies.named); b < fields.scale.size(); ++b)
    {
        const auto&  form   = world.templates[static_cast<std::size_t>(fields.shape[b])];
        const double radius = fields.scale[b] * form.equivalent_radius;
        tops.emplace_back(Vec3<double>(fields.position.data() + 3 * b) + radius * Vec3<double>::UnitZ());
        mean_radius += radius / static_cast<double>(rocks);
    }
    const double width = 4 * mean_radius;
    return middle_height(surface_columns(tops, width), bodies, width);
}

} // namespace tread::solver
