#include <limits>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "solver/coupling/sand_body_coupling.hpp"
#include "solver/state_file.hpp"

// Saves sand-body contact records to a checkpoint, and loads them.
namespace tread::solver
{
namespace
{

auto accepted_contact_keys(const ContactPartners& partners)
{
    const auto names_a_pair = [partners](std::uint64_t key)
    { return key >> 36 < partners.bodies && contact::point_of(key) < partners.ids && (key & 15) != 0; };
    return accept::each(fmt::format("the key of one of {} bodies and one of {} points", partners.bodies, partners.ids),
                        names_a_pair);
}

} // namespace

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::transfer(StateFile& file, const dem::BodiesView& bodies,
                                            const ContactPartners& partners)
{
    const double nobody = -1, last = static_cast<double>(partners.bodies) - 1;
    const auto   body = [&](std::int32_t& value) { return accept::number(value, nobody, last); };
    file.numbers("contact/steps", accept::number(used_, 0, accept::largest),
                 accept::number(used_by_sand_, 0, accept::largest), accept::number(span_, 0, accept::largest), version_,
                 list_, accept::number(begun_, 0, 0)); // a step that has begun is not saved
    file.numbers("contact/summary", summary_.live, summary_.live_named, summary_.energy, summary_.dissipated,
                 summary_.stiffest.value, body(summary_.stiffest.body), summary_.stiffest.point_id,
                 summary_.deepest.value, body(summary_.deepest.body), summary_.deepest.point_id,
                 accept::number(summary_.flattest.value, 0, std::numeric_limits<double>::infinity()),
                 body(summary_.flattest.body), summary_.flattest.point_id);
    std::vector<contact::HistoryRecord> records;
    if (!file.loads()) { records = remembered(); }
    transfer_records(file, records, partners);
    if (file.exact()) { transfer_candidates(file, bodies, partners); }
    if (!file.loads()) { return; }
    if (!file.exact())
    {
        contact_.tangential.resize(0); // the next search uses the records instead
        version_ = 0;
        begun_   = false;
    }
    if (contact_.tangential.size() == 0) { contact::put_back(exec_, contact_.history, records); }
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::transfer_sleep(StateFile& file, const dem::BodiesView& bodies,
                                                  dem::SleepingBodies<Exec>& sleepers, const ContactPartners& partners)
{
    const auto are_keys = accept::all(accepted_contact_keys(partners), accept::distinct());
    if (!file.exact())
    {
        wake_records(file, are_keys);
        return;
    }
    file.own("contact/asleep_key", asleep_.key, accept::all(are_keys, accept::ascending()));
    const auto rows = accept::rows(static_cast<std::size_t>(asleep_.key.size()));
    file.own("contact/asleep_tangential", asleep_.tangential, accept::all(rows, accept::finite()));
    file.own("contact/asleep_response", asleep_.response, accept::all(rows, accept::finite()));
    file.own("contact/asleep_material", asleep_.material, accept::all(rows, accept::index(partners.materials)));
    if (file.loads()) { sum_asleep(bodies, sleepers); }
}

/// Adds the records of the contacts that slept to those of the others.
template<class Exec, class Real>
template<class Bound>
void SandBodyCoupling<Exec, Real>::wake_records(StateFile& file, const Bound& are_keys)
{
    std::vector<std::uint64_t>       keys;
    std::vector<contact::Tangential> tangential;
    file.own_or_all("contact/asleep_key", keys, are_keys);
    file.own_or_all("contact/asleep_tangential", tangential, accept::all(accept::rows(keys.size()), accept::finite()));
    std::vector<contact::HistoryRecord> records;
    for (std::size_t i = 0; i < keys.size(); ++i) { records.push_back({keys[i], tangential[i]}); }
    contact::add_records(exec_, contact_.history, records);
}

/// If pairs hold their records, moves them to the table, reads it, and clears it.
template<class Exec, class Real>
std::vector<contact::HistoryRecord> SandBodyCoupling<Exec, Real>::remembered()
{
    if (contact_.tangential.size() == 0) { return contact::read_out(contact_.history); }
    contact::keep_history(exec_, contact_);
    std::vector<contact::HistoryRecord> records = contact::read_out(contact_.history);
    contact::put_back(exec_, contact_.history, {});
    return records;
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::transfer_records(StateFile& file, std::vector<contact::HistoryRecord>& records,
                                                    const ContactPartners& partners)
{
    std::vector<std::uint64_t>       keys;
    std::vector<contact::Tangential> tangential;
    for (const contact::HistoryRecord& record : records)
    {
        keys.push_back(record.key);
        tangential.push_back(record.tangential);
    }
    file.own_or_all("contact/key", keys, accept::all(accepted_contact_keys(partners), accept::distinct()));
    file.own_or_all("contact/tangential", tangential, accept::all(accept::rows(keys.size()), accept::finite()));
    records.clear();
    for (std::size_t i = 0; i < keys.size(); ++i) { records.push_back({keys[i], tangential[i]}); }
}

/// Listed pairs have a slot whether or not they have a record; the next search files the records under the point ids
/// that the last step has copied.
template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::transfer_candidates(StateFile& file, const dem::BodiesView& bodies,
                                                       const ContactPartners& partners)
{
    std::vector<std::int32_t> body  = contact_.candidates.body.to_host();
    std::vector<std::int32_t> point = contact_.candidates.point.to_host();
    file.own("candidates/body", body,
             accept::all(accept::index(static_cast<std::size_t>(bodies.count)), accept::ascending()));
    file.own("candidates/point", point, accept::all(accept::rows(body.size()), accept::index(partners.points)));
    if (file.loads())
    {
        contact_.candidates.body.assign(body);
        contact_.candidates.point.assign(point);
        contact::resume_candidates(exec_, contact_, bodies, law_);
    }
    transfer_slots(file, partners);
}

/// Before loading, there must be a slot for each candidate.
template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::transfer_slots(StateFile& file, const ContactPartners& partners)
{
    std::vector<contact::Tangential> tangential = contact_.tangential.to_host();
    std::vector<std::uint32_t>       ids        = contact_.id.to_host();
    const std::size_t                slots = tangential.size(), points = ids.size();
    file.own("candidates/tangential", tangential, accept::all(accept::rows(slots), accept::finite()));
    file.own("candidates/id", ids, accept::all(accept::rows(points), accept::index(partners.ids)));
    if (!file.loads()) { return; }
    contact_.tangential.assign(tangential);
    contact_.id.assign(ids);
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void SandBodyCoupling<Exec, Real>::transfer(StateFile&, const dem::BodiesView&, const ContactPartners&);  \
    template void SandBodyCoupling<Exec, Real>::transfer_sleep(StateFile&, const dem::BodiesView&,                     \
                                                               dem::SleepingBodies<Exec>&, const ContactPartners&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
