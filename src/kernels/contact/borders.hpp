#pragma once

#include <array>

#include "kernels/dem/pairs/pairs.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

// Bodies near pages of other ranks, which the host decides about; most bodies of a rank are none, and stay on the
// backend.
namespace tread::contact
{

/// What may meet a body before the next search for pairs, m.
struct BorderReach
{
    double met_by_large; ///< largest own reach of any body, of any rank, plus a slack
    double met_by_small; ///< likewise of small bodies, which look for large ones no further
    double sand;         ///< distance within which the owner of sand must hold a body
};

/// Balls within which other ranks matter to a body.
struct BorderBody
{
    Vec3<double> position; ///< m, of the body
    double       radius;   ///< m, of its bounding sphere
    mpm::Reach   reach;    ///< m
};

/// A ball around a place in which all is known to be one rank's: its radius, m, for bodies and for sand.
struct Clearance
{
    Vec3<double> position{0.0, 0.0, 0.0}; ///< m
    mpm::Reach   within{-1.0, -1.0};      ///< nothing is known
};

template<class Exec>
struct Borders
{
    explicit Borders(const Exec& exec)
        : clear(exec, "balls inside a rank")
        , body(exec, "bodies at borders")
        , ball(exec, "balls of bodies at borders")
    {
    }

    Array<Exec, Clearance>    clear; ///< around each body when it was looked at last
    Array<Exec, std::int32_t> body;  ///< those found last, ascending
    Array<Exec, BorderBody>   ball;  ///< of each of them
};

/// Begins with so many bodies, of which nothing is known.
template<class Exec>
void begin_borders(const Exec&, Borders<Exec>& borders, std::int64_t bodies);

/// Forgets what is this rank's alone: owners of pages have changed.
template<class Exec>
void forget_clearances(const Exec&, Borders<Exec>& borders);

/// Takes these balls around these bodies as this rank's alone.
template<class Exec>
void keep_clearances(const Exec&, Borders<Exec>& borders, const std::vector<std::int32_t>& body,
                     const std::vector<Clearance>& clear);

/// Largest own reach, bounding radius plus allowed displacement, m, of this rank's bodies: of all, and of the small
/// ones. `bounding_radius`: m, of each body, here and below. Waits.
template<class Exec>
std::array<double, 2> largest_reaches(const Exec&, const double* bounding_radius, dem::Pairs<Exec>& pairs,
                                      const dem::BodiesView& bodies);

/// Lists this rank's bodies that are not known to reach this rank's pages alone. Waits for their number.
template<class Exec>
void list_borders(const Exec&, Borders<Exec>& borders, const double* bounding_radius, dem::Pairs<Exec>& pairs,
                  const dem::BodiesView& bodies, const BorderReach& reach);

/// Sets place[body[i]] to i.
template<class Exec>
void write_places(const Exec&, const Array<Exec, std::int32_t>& body, Array<Exec, std::int32_t>& place);

/// Sets all places to -1.
template<class Exec>
void forget_places(const Exec&, Array<Exec, std::int32_t>& place);

} // namespace tread::contact
