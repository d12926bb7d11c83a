#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace tread::world
{

/// Space occupied by sand, by [[terrain]] table: the cubes of the volume of its points. Later changes of the sand
/// have no effect. Thread-safe.
class SandMap
{
public:
    SandMap(const scene::Scene& scene, const Sand& sand);

    /// Whether x lies in the sand of a table.
    bool holds(std::int32_t table, const Vec3<double>& x) const;

    /// Whether x lies in the sand of any table.
    bool holds(const Vec3<double>& x) const;

private:
    /// Occupied lattice sites of a table, one bit a site.
    struct Sites
    {
        Vec3<double>                low     = Vec3<double>::Zero(); ///< m, corner of the first site
        double                      spacing = 0;                    ///< m; 0 = the table has no points
        std::array<std::int64_t, 3> size{};
        std::vector<bool>           taken;
    };

    static std::int64_t site(const Sites& sites, const Vec3<double>& x);

    std::vector<Sites> tables_;
};

} // namespace tread::world
