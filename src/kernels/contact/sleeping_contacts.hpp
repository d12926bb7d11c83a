#pragma once

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/sleep/sleeping_bodies.hpp"

// Contacts of sand and bodies that both sleep. Neither moves, so that forces and records stay as they are; no kernel of
// the substeps has such contacts.
namespace tread::contact
{

/// Response of a contact that sleeps.
struct HeldSand
{
    dem::ContactWrench wrench; ///< on the body
    double             energy; ///< J, elastic
};

/// Memory of the contacts that sleep, a row for each record of friction. The first row of a contact has its whole
/// response; further ones, of a point that takes samples, have none.
template<class Exec>
struct SleepingContacts
{
    explicit SleepingContacts(const Exec& exec)
        : key(exec, "sleeping contact keys")
        , tangential(exec, "sleeping contact records")
        , response(exec, "sleeping contact responses")
        , material(exec, "sleeping contact materials")
    {
    }

    Array<Exec, std::uint64_t> key; ///< history_key, ascending
    Array<Exec, Tangential>    tangential;
    Array<Exec, HeldSand>      response;
    Array<Exec, std::int32_t>  material; ///< of the point

    double energy = 0; ///< J, of all
};

/// Takes the contacts of points that have just fallen asleep with bodies that sleep: points `first` and later of
/// `asleep`. They are computed once more where the points are, at rest. Sets loaded[b] to 1 for their bodies. The
/// contacts of `contact` must be those of the last step. Returns what friction dissipated by that (J).
template<class Exec, class Real>
double take_contacts(const Exec& exec, PointContact<Exec>& contact, SleepingContacts<Exec>& sleeping,
                     const mpm::PointsView<Real>& asleep, std::int64_t first, const dem::BodiesView& bodies,
                     const PointBodyLaw& law, std::int32_t* loaded);

/// Gives the records of points that have just woken back to the history of `contact`, for the next search: points
/// `first` and later of `awake`.
template<class Exec, class Real>
void return_contacts(const Exec& exec, PointContact<Exec>& contact, SleepingContacts<Exec>& sleeping,
                     const mpm::PointsView<Real>& awake, std::int64_t first);

/// Sums the responses by body, press[bodies], and their energy.
template<class Exec>
void sum_sleeping(const Exec& exec, SleepingContacts<Exec>& sleeping, const dem::BodiesView& bodies,
                  Array<Exec, dem::ContactWrench>& press);

} // namespace tread::contact
