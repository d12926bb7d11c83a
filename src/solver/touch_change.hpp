#pragma once

#include <cstdint>
#include <vector>

#include "world/touch_table.hpp"

namespace tread::solver
{

/// Largest overlap of a pair that begins to touch, over the smaller radius of the two (of sand: the point's).
/// Assumed: it allows for rounding. A contact that began with more would have energy from nowhere.
inline constexpr double deepest_new_touch = 1e-6;

/// Pairs of materials that touch before and after the border of two phases.
struct TouchChange
{
    world::TouchTable before;
    world::TouchTable after;

    bool any() const { return !(before == after); }
    bool any_begins() const;

    template<class A, class B>
    bool begins(A a, B b) const
    {
        return after(a, b) && !before(a, b);
    }

    template<class A, class B>
    bool ends(A a, B b) const
    {
        return before(a, b) && !after(a, b);
    }
};

/// Overlaps of points with a body, of pairs that begin to touch.
struct NewTouch
{
    std::int64_t points  = 0;  ///< number of points that are deeper than deepest_new_touch of their radius
    double       overlap = 0;  ///< m, of the deepest
    double       most    = 0;  ///< m, accepted for it
    std::int32_t body    = -1; ///< that it overlaps
};

/// Overlaps of both, with the deepest of them.
NewTouch together(const NewTouch& one, const NewTouch& other);

/// J, elastic energy of the contacts of each pair of materials: [sides x sides], row-major, smaller index first.
struct ContactEnergies
{
    std::vector<double> bodies; ///< of bodies with bodies and walls
    std::vector<double> sand;   ///< of sand with bodies
};

/// J, sum over the pairs that cease to touch.
double released(const TouchChange& change, const std::vector<double>& energies);

} // namespace tread::solver
