#pragma once

#include "kernels/contact/point_contact_kern.hpp"
#include "kernels/contact/sleeping_contacts.hpp"

// Item functions of sleeping_contacts.hpp.
namespace tread::contact::sleeping_steps
{

using contact_steps::CopyPoint;
using contact_steps::slot_key;

/// Points by ascending id.
struct PointsById
{
    std::int64_t         count;
    const std::uint64_t* id;
    const std::int32_t*  at; ///< index in memory

    TREAD_HD bool has(std::uint32_t point) const { return find(point) >= 0; }

    /// Returns the index in memory of a point; -1 if it is none of these.
    TREAD_HD std::int64_t find(std::uint32_t point) const
    {
        const std::int64_t place = find_sorted(id, count, static_cast<std::uint64_t>(point));
        return place < 0 ? -1 : at[place];
    }
};

struct WriteId
{
    const std::uint32_t* id;
    std::int64_t         first;
    std::uint64_t*       key;
    std::int32_t*        at;

    TREAD_HD void operator()(std::int64_t i) const
    {
        key[i] = id[first + i];
        at[i]  = static_cast<std::int32_t>(first + i);
    }
};

/// Puts the private copy of a point that has fallen asleep where the point is.
template<class Real>
struct PlaceFallen
{
    PointsById      fallen;
    CopyPoint<Real> copy;

    TREAD_HD void operator()(std::int64_t t) const
    {
        const std::int64_t p = fallen.find(copy.copy.id[t]);
        if (p >= 0) { copy.take(t, p); }
    }
};

/// Whether both sides of a candidate sleep from now on.
struct FallsAsleep
{
    PointsById           fallen;
    CandidatesView       candidates;
    const std::uint32_t* id; ///< of the private points
    dem::BodiesView      bodies;

    TREAD_HD bool operator()(std::int64_t c) const
    {
        return bodies.is_asleep(candidates.body[c]) && fallen.has(id[candidates.touched[c]]);
    }
};

/// Computes a contact at rest. EachForce: Respond or RespondSampled.
template<class EachForce>
struct RespondAtRest
{
    FallsAsleep falls;
    EachForce   respond;

    TREAD_HD void operator()(std::int64_t c) const
    {
        if (falls(c)) { respond(c); }
    }
};

struct CountRows
{
    FallsAsleep   falls;
    ContactsView  contacts;
    std::int32_t* rows; ///< [count + 1]

    TREAD_HD void operator()(std::int64_t c) const
    {
        rows[c] = 0;
        if (c == contacts.candidates.count || !falls(c)) { return; }
        for (std::int64_t s = contacts.first_slot(c); s < contacts.first_slot(c + 1); ++s)
        {
            rows[c] += is_known(contacts.tangential[s].normal) ? 1 : 0;
        }
    }
};

struct RowsView
{
    std::uint64_t* key;
    Tangential*    tangential;
    HeldSand*      response;
    std::int32_t*  material;

    TREAD_HD void take(std::int64_t to, const RowsView& from, std::int64_t i) const
    {
        key[to]        = from.key[i];
        tangential[to] = from.tangential[i];
        response[to]   = from.response[i];
        material[to]   = from.material[i];
    }
};

template<class Exec>
RowsView rows_of(SleepingContacts<Exec>& sleeping)
{
    return {sleeping.key.data(), sleeping.tangential.data(), sleeping.response.data(), sleeping.material.data()};
}

/// Writes the rows of a contact that falls asleep; several threads may mark one body.
struct WriteRows
{
    ContactsView        contacts;
    PrivatePoints       points;
    const Vec3<double>* body_position;
    const std::int32_t* first; ///< [count + 1], after the scan
    RowsView            rows;
    double*             dissipated; ///< J, of each row
    std::int32_t*       loaded;     ///< 1: of each body with such a contact

    TREAD_HD void operator()(std::int64_t c) const
    {
        if (first[c + 1] == first[c]) { return; }
        const std::int32_t b = contacts.candidates.body[c], t = contacts.candidates.touched[c];
        const Response&    found = contacts.response[c];
        HeldSand     held = {contact_steps::wrench_on_body(found, points.position[t] - body_position[b]), found.energy};
        double       lost = found.dissipated;
        std::int64_t row  = first[c];
        for (std::int64_t s = contacts.first_slot(c); s < contacts.first_slot(c + 1); ++s)
        {
            if (!is_known(contacts.tangential[s].normal)) { continue; }
            rows.key[row]        = slot_key(contacts, points.id, c, s);
            rows.tangential[row] = contacts.tangential[s];
            rows.response[row]   = held;
            rows.material[row]   = points.material[t];
            dissipated[row]      = lost;
            held                 = {dem::ContactWrench::zero(), 0.0};
            lost                 = 0;
            ++row;
        }
        loaded[b] = 1;
    }
};

/// Whether the point of a row has woken, or has not.
struct Woken
{
    PointsById           points;
    const std::uint64_t* key;

    TREAD_HD bool operator()(std::int64_t row) const { return points.has(point_of(key[row])); }
};

struct Stays
{
    Woken woken;

    TREAD_HD bool operator()(std::int64_t row) const { return !woken(row); }
};

struct ReturnRecord
{
    const std::int32_t* list;
    RowsView            rows;
    std::int64_t        before; ///< records of the history that stay
    std::uint64_t*      key;
    Tangential*         tangential;

    TREAD_HD void operator()(std::int64_t i) const
    {
        key[before + i]        = rows.key[list[i]];
        tangential[before + i] = rows.tangential[list[i]];
    }
};

/// Copies the rows of a list.
struct TakeListed
{
    const std::int32_t* list;
    RowsView            from;
    RowsView            to;

    TREAD_HD void operator()(std::int64_t i) const { to.take(i, from, list[i]); }
};

/// Writes keys and origins of old and new rows: i = row i of the old, and further ones of the new.
struct WriteKeys
{
    std::int64_t         old;
    const std::uint64_t* old_key;
    const std::uint64_t* new_key;
    std::uint64_t*       key;
    std::int32_t*        origin;

    TREAD_HD void operator()(std::int64_t i) const
    {
        key[i]    = i < old ? old_key[i] : new_key[i - old];
        origin[i] = static_cast<std::int32_t>(i);
    }
};

struct Merge
{
    std::int64_t        old;
    RowsView            old_rows;
    RowsView            new_rows;
    const std::int32_t* origin;
    RowsView            to;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t from = origin[i];
        if (from < old) { to.take(i, old_rows, from); }
        else { to.take(i, new_rows, from - old); }
    }
};

/// Sums the rows of a body.
struct SumRows
{
    std::int64_t         count;
    const std::uint64_t* key;
    const HeldSand*      response;
    const std::int32_t*  number; ///< of each body in the scene; null: that of its row
    dem::ContactWrench*  press;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const std::int64_t body  = number != nullptr ? number[b] : b;
        const auto         first = static_cast<std::uint64_t>(body) << 36;
        dem::ContactWrench sum   = dem::ContactWrench::zero();
        for (std::int64_t row = lower_bound(key, count, first); row < count && body_of(key[row]) == body; ++row)
        {
            sum = sum + response[row].wrench;
        }
        press[b] = sum;
    }
};

struct WriteEnergyOfRow
{
    const HeldSand* response;
    double*         energy;

    TREAD_HD void operator()(std::int64_t row) const { energy[row] = response[row].energy; }
};

} // namespace tread::contact::sleeping_steps
