#pragma once

#include <cstdint>
#include <limits>

#include "backend/vector.hpp"

// Sums and extremes over contacts. Sums have a fixed order (sum_chunks); of equal extremes the first is kept.
namespace tread::contact
{

/// An extreme value and its pair; body -1 = no contact.
struct Extreme
{
    double        value;
    std::int32_t  body;
    std::uint32_t point_id;
};

TREAD_HD Extreme larger(const Extreme& a, const Extreme& b) { return b.value > a.value ? b : a; }
TREAD_HD Extreme smaller(const Extreme& a, const Extreme& b) { return b.value < a.value ? b : a; }

/// Summary of the live contacts of one body or of all.
struct Summary
{
    std::int64_t live;       ///< number of contacts with overlap
    std::int64_t live_named; ///< those of the bodies that the caller asked for
    double       energy;     ///< J, elastic, normal and tangential
    double       dissipated; ///< J, dissipated by friction
    Extreme      stiffest;   ///< 1/s2, k_n / m_p: the time step must satisfy k_n dt^2 / m_p <= 0.5
    Extreme      deepest;    ///< overlap divided by point radius
    /// Minimum |grad phi| of points whose centre is inside the body; below 0.5 the point is at a medial axis. Outside,
    /// small values have no meaning: an interpolated distance is flat along a concave edge.
    Extreme flattest;

    TREAD_HD static Summary zero()
    {
        return {0, 0, 0.0, 0.0, {0.0, -1, 0}, {0.0, -1, 0}, {std::numeric_limits<double>::infinity(), -1, 0}};
    }
};

TREAD_HD Summary operator+(const Summary& a, const Summary& b)
{
    return {a.live + b.live,
            a.live_named + b.live_named,
            a.energy + b.energy,
            a.dissipated + b.dissipated,
            larger(a.stiffest, b.stiffest),
            larger(a.deepest, b.deepest),
            smaller(a.flattest, b.flattest)};
}

} // namespace tread::contact
