#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "io/bed_file.hpp"
#include "require.hpp"

namespace tread::fuzz
{

/// Ends the process unless the bed's numbers are in range.
inline void require_sound(const io::BedFile& bed)
{
    require(bed.position.size() == 3 * bed.size() && bed.orientation.size() == 4 * bed.size());
    for (const std::int32_t kind : bed.kind)
    {
        require(kind >= 0 && static_cast<std::size_t>(kind) < bed.kinds.size());
    }
    for (const double scale : bed.scale) { require(std::isfinite(scale) && scale > 0); }
    for (std::size_t i = 0; i < bed.contacts.pair.size(); i += 2)
    {
        require(bed.contacts.pair[i] >= 0 && static_cast<std::size_t>(bed.contacts.pair[i]) < bed.size());
    }
    for (const std::int32_t material : bed.points.material)
    {
        require(material >= 0 && static_cast<std::size_t>(material) < bed.points.materials.size());
    }
    for (const double mass : bed.points.mass) { require(std::isfinite(mass) && mass > 0); }
}

} // namespace tread::fuzz
