#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace tread::shape
{

/// Spatial hash of surface points with normals.
class PointDirectory
{
public:
    /// Cosine of a normal angle over 120 degrees: it occurs across a thin wall, but not around its edge.
    static constexpr double facing_away = -0.5;

    explicit PointDirectory(double radius)
        : squared_radius_(radius * radius)
        , cell_(2 * radius)
    {
    }

    void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal)
    {
        cells_[key(cell_of(position))].push_back({position, normal, added_++});
    }

    /// Removes the point that was added as number `index`, at `position`.
    void remove(std::size_t index, const Eigen::Vector3d& position)
    {
        std::vector<Point>& points = cells_.at(key(cell_of(position)));
        *std::find_if(points.begin(), points.end(), [&](const Point& point) { return point.index == index; }) =
            points.back();
        points.pop_back();
    }

    /// Calls visit(index, squared distance) for the points within the radius on the same side of the body, whose
    /// normals do not face away.
    template<class Visit>
    void for_each_near(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, Visit visit) const
    {
        const Cell low = cell_of(position - Eigen::Vector3d::Constant(0.5 * cell_));
        for (int c = 0; c < 8; ++c)
        {
            const auto found = cells_.find(key(low + Cell(c & 1, (c >> 1) & 1, c >> 2)));
            if (found == cells_.end()) { continue; }
            for (const Point& point : found->second)
            {
                const double squared = (point.position - position).squaredNorm();
                if (squared < squared_radius_ && point.normal.dot(normal) >= facing_away)
                {
                    visit(point.index, squared);
                }
            }
        }
    }

    std::optional<std::size_t> nearest(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const
    {
        std::optional<std::size_t> best;
        double                     least = squared_radius_;
        for_each_near(position, normal,
                      [&](std::size_t at, double squared)
                      {
                          if (squared >= least) { return; }
                          least = squared;
                          best  = at;
                      });
        return best;
    }

private:
    using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

    struct Point
    {
        Eigen::Vector3d position;
        Eigen::Vector3d normal;
        std::size_t     index;
    };

    Cell cell_of(const Eigen::Vector3d& position) const
    {
        return (position / cell_).array().floor().cast<std::int64_t>();
    }

    static std::uint64_t key(const Cell& cell)
    {
        constexpr std::int64_t half = 1 << 20; // cells on either side of the origin
        const auto low = [&](std::int64_t c) { return static_cast<std::uint64_t>(c + half) & (2 * half - 1); };
        return low(cell.x()) | low(cell.y()) << 21 | low(cell.z()) << 42;
    }

    double                                                squared_radius_;
    double                                                cell_;
    std::size_t                                           added_ = 0;
    std::unordered_map<std::uint64_t, std::vector<Point>> cells_;
};

} // namespace tread::shape
