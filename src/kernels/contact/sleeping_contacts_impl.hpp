#pragma once

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "kernels/contact/sleeping_contacts_kern.hpp"
#include "kernels/dem/pairs/select.hpp"

// Steps of sleeping_contacts.hpp, for both backends; sleeping_contacts.cpp and sleeping_contacts.cu provide for_each.
namespace tread::contact
{
namespace sleeping_steps
{

/// Memory of PointsById.
template<class Exec>
struct PointList
{
    /// Lists points `first` and later.
    template<class Real>
    PointList(const Exec& exec, const mpm::PointsView<Real>& points, std::int64_t first, SortScratch<Exec>& scratch)
        : id(exec, "ids of moved points", points.count - first)
        , at(exec, "places of moved points", points.count - first)
    {
        for_each(exec, "ids of moved points", id.size(), WriteId{points.id, first, id.data(), at.data()});
        constexpr int id_bits = 32;
        sort_by_key(exec, id, at, scratch, id_bits);
    }

    PointsById view() const { return {id.size(), id.data(), at.data()}; }

    Array<Exec, std::uint64_t> id;
    Array<Exec, std::int32_t>  at;
};

template<class Exec>
void resize(SleepingContacts<Exec>& sleeping, std::int64_t rows)
{
    sleeping.key.resize(rows);
    sleeping.tangential.resize(rows);
    sleeping.response.resize(rows);
    sleeping.material.resize(rows);
}

template<class Exec>
void swap(SleepingContacts<Exec>& one, SleepingContacts<Exec>& other)
{
    one.key.swap(other.key);
    one.tangential.swap(other.tangential);
    one.response.swap(other.response);
    one.material.swap(other.material);
}

/// Adds rows, whose keys differ from all present ones.
template<class Exec>
void merge(const Exec& exec, SleepingContacts<Exec>& sleeping, SleepingContacts<Exec>& more, SortScratch<Exec>& scratch)
{
    const std::int64_t        old = sleeping.key.size(), count = old + more.key.size();
    SleepingContacts<Exec>    all(exec);
    Array<Exec, std::int32_t> origin(exec, "origins of sleeping contacts", count);
    resize(all, count);
    for_each(exec, "keys of sleeping contacts", count,
             WriteKeys{old, sleeping.key.data(), more.key.data(), all.key.data(), origin.data()});
    sort_by_key(exec, all.key, origin, scratch);
    for_each(exec, "merge sleeping contacts", count,
             Merge{old, rows_of(sleeping), rows_of(more), origin.data(), rows_of(all)});
    swap(sleeping, all);
}

/// Computes the contacts that fall asleep once more, where their points are now.
template<class Exec, class Real>
void respond_at_rest(const Exec& exec, PointContact<Exec>& contact, const FallsAsleep& falls,
                     const mpm::PointsView<Real>& asleep, const dem::BodiesView& bodies, const PointBodyLaw& law)
{
    const ContactsView  contacts = contact.contacts();
    const PrivatePoints points   = contact.private_points();
    for_each(exec, "place fallen points", points.count,
             PlaceFallen<Real>{falls.fallen, {asleep, {}, law.radius, law.motion, points}});
    const contact_steps::Respond respond{contacts, points, bodies, law, 0.0};
    const std::int64_t           count = contacts.candidates.count;
    if (contacts.slot_first == nullptr)
    {
        for_each(exec, "contacts at rest", count, RespondAtRest<contact_steps::Respond>{falls, respond});
    }
    else
    {
        for_each(exec, "sampled contacts at rest", count,
                 RespondAtRest<contact_steps::RespondSampled>{falls, {respond}});
    }
}

} // namespace sleeping_steps

template<class Exec, class Real>
double take_contacts(const Exec& exec, PointContact<Exec>& contact, SleepingContacts<Exec>& sleeping,
                     const mpm::PointsView<Real>& asleep, std::int64_t first, const dem::BodiesView& bodies,
                     const PointBodyLaw& law, std::int32_t* loaded)
{
    using namespace sleeping_steps;
    const std::int64_t count = contact.tangential.size() == 0 ? 0 : contact.candidates.body.size();
    if (count == 0 || first == asleep.count) { return 0; }
    SortScratch<Exec>&        scratch = contact.candidates.sort;
    const PointList<Exec>     fallen(exec, asleep, first, scratch);
    const FallsAsleep         falls{fallen.view(), contact.candidates.view(), contact.id.data(), bodies};
    Array<Exec, std::int32_t> first_row(exec, "first rows of sleeping contacts", count + 1);
    respond_at_rest(exec, contact, falls, asleep, bodies, law);
    for_each(exec, "count sleeping contacts", count + 1, CountRows{falls, contact.contacts(), first_row.data()});
    const std::int64_t rows = exclusive_scan(exec, first_row, scratch);
    if (rows == 0) { return 0; }
    SleepingContacts<Exec> more(exec);
    resize(more, rows);
    Array<Exec, double> lost(exec, "losses of sleeping contacts", rows + 1);
    for_each(exec, "write sleeping contacts", count,
             WriteRows{contact.contacts(), contact.private_points(), bodies.position, first_row.data(), rows_of(more),
                       lost.data(), loaded});
    merge(exec, sleeping, more, scratch);
    sum_rows(exec, lost.data(), rows, 1, lost.data() + rows);
    return read(exec, lost.data() + rows);
}

template<class Exec, class Real>
void return_contacts(const Exec& exec, PointContact<Exec>& contact, SleepingContacts<Exec>& sleeping,
                     const mpm::PointsView<Real>& awake, std::int64_t first)
{
    using namespace sleeping_steps;
    const std::int64_t count = sleeping.key.size();
    if (count == 0 || first == awake.count) { return; }
    SortScratch<Exec>&        scratch = contact.candidates.sort;
    const PointList<Exec>     points(exec, awake, first, scratch);
    const Woken               woken{points.view(), sleeping.key.data()};
    Array<Exec, std::int32_t> leave(exec, "contacts that wake"), stay(exec, "contacts that stay asleep");
    dem::select(exec, "contacts that wake", count, woken, contact.marks, scratch, leave);
    if (leave.size() == 0) { return; }
    dem::select(exec, "contacts that stay asleep", count, Stays{woken}, contact.marks, scratch, stay);

    keep_history(exec, contact);
    contact.tangential.resize(0); // the records are in the table until the next search
    const std::int64_t before = contact.history.key.size();
    extend(contact.history, leave.size());
    for_each(exec, "return contact records", leave.size(),
             ReturnRecord{leave.data(), rows_of(sleeping), before, contact.history.key.data(),
                          contact.history.tangential.data()});
    fill_bins(exec, contact.history);

    SleepingContacts<Exec> rest(exec);
    resize(rest, stay.size());
    for_each(exec, "keep sleeping contacts", stay.size(), TakeListed{stay.data(), rows_of(sleeping), rows_of(rest)});
    swap(sleeping, rest);
}

template<class Exec>
void sum_sleeping(const Exec& exec, SleepingContacts<Exec>& sleeping, const dem::BodiesView& bodies,
                  Array<Exec, dem::ContactWrench>& press)
{
    using namespace sleeping_steps;
    const std::int64_t count = sleeping.key.size();
    press.resize(bodies.count);
    for_each(exec, "press of sleeping sand", bodies.count,
             SumRows{count, sleeping.key.data(), sleeping.response.data(), bodies.number, press.data()});
    Array<Exec, double> energy(exec, "energies of sleeping contacts", count + 1);
    for_each(exec, "energies of sleeping contacts", count, WriteEnergyOfRow{sleeping.response.data(), energy.data()});
    sum_rows(exec, energy.data(), count, 1, energy.data() + count);
    sleeping.energy = read(exec, energy.data() + count);
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void sum_sleeping(const Exec&, SleepingContacts<Exec>&, const dem::BodiesView&,                           \
                               Array<Exec, dem::ContactWrench>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE
#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template double take_contacts(const Exec&, PointContact<Exec>&, SleepingContacts<Exec>&,                           \
                                  const mpm::PointsView<Real>&, std::int64_t, const dem::BodiesView&,                  \
                                  const PointBodyLaw&, std::int32_t*);                                                 \
    template void   return_contacts(const Exec&, PointContact<Exec>&, SleepingContacts<Exec>&,                         \
                                    const mpm::PointsView<Real>&, std::int64_t)
TREAD_FOR_THIS_BACKEND_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::contact
