#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Cells of a lattice that bodies reach, one bit each. Of many points most are near no body: this says so by one lookup
/// instead of a search in a BodyGrid. Thread-safe.
class ReachedCells
{
public:
    /// `reach`: m, beyond each body's bounding sphere.
    ReachedCells(const World& world, double reach);

    /// False where no bounding sphere is within reach of x, m; true may be wrong by a cell.
    bool may_be_near(const Vec3<double>& x) const
    {
        std::array<std::int64_t, 3> at{};
        for (std::size_t c = 0; c < 3; ++c)
        {
            const double offset = (x[static_cast<Eigen::Index>(c)] - low_[static_cast<Eigen::Index>(c)]) * per_cell_;
            if (!(offset >= 0 && offset < static_cast<double>(size_[c]))) { return false; }
            at[c] = static_cast<std::int64_t>(offset);
        }
        return reached_[index(at[0], at[1], at[2])];
    }

private:
    std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const
    {
        return static_cast<std::size_t>((k * size_[1] + j) * size_[0] + i);
    }

    void mark(const Vec3<double>& centre, double radius);

    Vec3<double>                low_      = Vec3<double>::Zero(); ///< m, corner of the first cell
    double                      per_cell_ = 0;                    ///< 1/m, one over the width of a cell
    std::array<std::int64_t, 3> size_{};
    std::vector<bool>           reached_;
};

} // namespace tread::world
