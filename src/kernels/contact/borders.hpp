#pragma once

#include <array>

#include "kernels/dem/pairs/pairs.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

// Bodies about which the host decides which ranks hold them. A decision lasts until a body may leave the balls that it
// was made for; most bodies of a rank stay on the backend.
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

/// Balls around a place, for bodies and for sand: who holds a body stays the same while its own balls are inside them.
struct Clearance
{
    Vec3<double> position{0.0, 0.0, 0.0}; ///< m
    mpm::Reach   within{-1.0, -1.0};      ///< m; below 0: nothing is known
};

template<class Exec>
struct Borders
{
    explicit Borders(const Exec& exec)
        : clear(exec, "balls of decisions")
        , body(exec, "bodies at borders")
        , ball(exec, "balls of bodies at borders")
    {
    }

    Array<Exec, Clearance>    clear; ///< of the last decision about each body
    Array<Exec, std::int32_t> body;  ///< those found last, ascending
    Array<Exec, BorderBody>   ball;  ///< of each of them
};

/// Begins with so many bodies, of which nothing is known.
template<class Exec>
void begin_borders(const Exec&, Borders<Exec>& borders, std::int64_t bodies);

/// Forgets all decisions: owners of pages have changed.
template<class Exec>
void forget_clearances(const Exec&, Borders<Exec>& borders);

/// Keeps what the decisions about these bodies hold for.
template<class Exec>
void keep_clearances(const Exec&, Borders<Exec>& borders, const std::vector<std::int32_t>& body,
                     const std::vector<Clearance>& clear);

/// Largest own reach, bounding radius plus allowed way, m, of this rank's bodies: of all, and of the small ones.
/// `bounding_radius`: m, of each body, here and below. Waits.
template<class Exec>
std::array<double, 2> largest_reaches(const Exec&, const double* bounding_radius, dem::Pairs<Exec>& pairs,
                                      const dem::BodiesView& bodies);

/// Lists this rank's bodies for which the last decision may not hold any more. Waits for their number.
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
