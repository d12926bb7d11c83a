#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace tread::solver
{

/// Command of a phase to one named body at one time.
struct BodyCommand
{
    std::uint32_t         locked = 0; ///< bits of dem::LockedFreedom
    std::optional<double> spin;       ///< rad/s about the axle
    std::optional<double> forward;    ///< m/s along x

    std::optional<std::array<double, 3>> lowering = {}; ///< m/s, velocity of a body that is lowered

    double weight = 1; ///< share of the body's weight that acts

    bool operator==(const BodyCommand&) const = default;
};

} // namespace tread::solver
