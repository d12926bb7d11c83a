#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kernels/dem/motion/prescribed.hpp"

namespace tread::solver
{

/// Command of a phase to one named body at one time.
struct BodyCommand
{
    std::uint32_t         locked = 0; ///< bits of BodiesView::locked
    std::optional<double> spin;       ///< rad/s about the axle
    std::optional<double> forward;    ///< m/s along x

    std::optional<std::array<double, 3>> lowering = {}; ///< m/s, velocity of a body that is lowered

    double weight = 1; ///< share of the body's weight that acts

    std::optional<dem::Prescribed> motion = {}; ///< only with the flag dem::prescribed in `locked`

    bool operator==(const BodyCommand&) const = default;
};

} // namespace tread::solver
