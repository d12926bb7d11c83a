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

/// A ball within which other ranks matter to a body.
struct BorderBody
{
    Vec3<double> position; ///< m, of the body
    double       radius;   ///< m
};

template<class Exec>
struct Borders
{
    explicit Borders(const Exec& exec)
        : bounding_radius(exec, "bounding radii of bodies")
        , inside(exec, "surroundings inside a rank")
        , body(exec, "bodies at borders")
        , ball(exec, "balls of bodies at borders")
        , at(exec, "bodies to set")
        , role(exec, "roles to set")
        , around(exec, "surroundings to set")
    {
    }

    Array<Exec, double>            bounding_radius; ///< m, of each body
    Array<Exec, mpm::Surroundings> inside;          ///< of each body: the last that were this rank's alone
    Array<Exec, std::int32_t>      body;            ///< those found last, ascending
    Array<Exec, BorderBody>        ball;            ///< of each of them

    // Scratch.
    Array<Exec, std::int32_t>      at;
    Array<Exec, std::int32_t>      role;
    Array<Exec, mpm::Surroundings> around;
};

/// Begins with `bounding_radius` (m) of each body, of which nothing is known.
template<class Exec>
void begin_borders(const Exec&, Borders<Exec>& borders, const std::vector<double>& bounding_radius);

/// Forgets which surroundings are this rank's alone: owners of pages have changed.
template<class Exec>
void forget_inside(const Exec&, Borders<Exec>& borders);

/// Takes these surroundings of these bodies as this rank's alone.
template<class Exec>
void keep_inside(const Exec&, Borders<Exec>& borders, const std::vector<std::int32_t>& body,
                 const std::vector<mpm::Surroundings>& around);

/// Largest own reach, bounding radius plus allowed displacement, m, of this rank's bodies: of all, and of the small
/// ones. Waits.
template<class Exec>
std::array<double, 2> largest_reaches(const Exec&, Borders<Exec>& borders, dem::Pairs<Exec>& pairs,
                                      const dem::BodiesView& bodies);

/// Lists this rank's bodies whose surroundings are not known to be this rank's alone. Waits for their number.
template<class Exec>
void list_borders(const Exec&, Borders<Exec>& borders, dem::Pairs<Exec>& pairs, const dem::BodiesView& bodies,
                  const mpm::PageLattice& lattice, const BorderReach& reach);

/// Sets the roles (dem::BodyRole) of these bodies, each of which occurs once.
template<class Exec>
void set_roles(const Exec&, Borders<Exec>& borders, const std::vector<std::int32_t>& body,
               const std::vector<std::int32_t>& role, dem::Bodies<Exec>& bodies);

/// Sets place[body[i]] to i.
template<class Exec>
void write_places(const Exec&, const Array<Exec, std::int32_t>& body, Array<Exec, std::int32_t>& place);

/// Sets place[body[i]] to -1.
template<class Exec>
void erase_places(const Exec&, const Array<Exec, std::int32_t>& body, Array<Exec, std::int32_t>& place);

} // namespace tread::contact
