#pragma once

#include "kernels/contact/point_contact_kern.hpp"

// Steps of the sand-body contact, for both backends; point_contact.cpp and point_contact.cu provide for_each and
// sum_chunks, and instantiate.
namespace tread::contact
{

/// Contacts whose summaries are added up together first: two a thread of a GPU's block.
constexpr std::int64_t summary_chunk = 256;

/// Allocates memory for the candidates found.
template<class Exec>
void resize_to_candidates(PointContact<Exec>& contact)
{
    const auto resize = [](std::int64_t size, auto&... arrays) { (arrays.resize(size), ...); };
    resize(contact.candidates.by_point.key.size(), contact.position, contact.velocity, contact.support, contact.impulse,
           contact.mass, contact.radius, contact.material, contact.id);
    resize(contact.candidates.body.size(), contact.response, contact.dissipated);
    const std::int64_t parts = contact.candidates.body_parts.of_items.key.size();
    if (parts == 0) { return; }
    resize(parts + 1, contact.wrench_sums); // or two per block for the substeps of a lone body
    resize(chunks_of(contact.candidates.body.size(), summary_chunk), contact.summary_sums);
    resize(1, contact.summary);
}

/// Allocates the history slots of the candidates found.
template<class Exec>
void make_slots(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies, const PointBodyLaw& law)
{
    const std::int64_t count = contact.candidates.body.size();
    std::int64_t       slots = count;
    if (law.sampled_below > 0 && count > 0)
    {
        contact.slot_first.resize(count + 1);
        for_each(exec, "count contact slots", count + 1,
                 contact_steps::CountSlots{contact.candidates.view(), bodies, law.templates, law.sampled_below,
                                           contact.slot_first.data()});
        slots = exclusive_scan(exec, contact.slot_first, contact.candidates.sort);
    }
    contact.tangential.resize(slots);
}

/// Copies the numbers of the bodies that the candidates are found for.
template<class Exec>
void copy_numbers(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies)
{
    if (bodies.number == nullptr) { return; }
    contact.number.resize(bodies.count);
    copy(exec, contact.number.data(), bodies.number, static_cast<std::size_t>(bodies.count) * sizeof(std::int32_t));
}

/// Writes the run of each body's wrenches.
template<class Exec>
void name_runs(const Exec& exec, PointContact<Exec>& contact, std::int64_t bodies)
{
    if (contact.candidates.body.size() == 0) { return; }
    contact.run_of_body.resize(bodies);
    for_each(exec, "bodies without sand", bodies, contact_steps::NoRun{contact.run_of_body.data()});
    const RunsView by_body = contact.candidates.by_body.view();
    for_each(exec, "bodies in sand", by_body.count, contact_steps::NameRun{by_body.key, contact.run_of_body.data()});
}

template<class Exec>
void resume_candidates(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies,
                       const PointBodyLaw& law)
{
    if (contact.candidates.body.size() > 0) { order_by_point(exec, contact.candidates); }
    resize_to_candidates(contact);
    make_slots(exec, contact, bodies, law);
    copy_numbers(exec, contact, bodies);
    name_runs(exec, contact, bodies.count);
    resize(contact.history, 0);
    if (contact.dissipated.size() > 0) { contact.dissipated.fill_zero(); }
}

template<class Exec>
void keep_history(const Exec& exec, PointContact<Exec>& contact)
{
    using namespace contact_steps;
    const std::int64_t slots = contact.tangential.size();
    if (slots == 0) { return; }
    contact.marks.resize(slots + 1);
    for_each(exec, "mark contact history", slots + 1,
             MarkRecords{slots, contact.tangential.data(), contact.marks.data()});
    const std::int64_t records = exclusive_scan(exec, contact.marks, contact.candidates.sort);
    resize(contact.history, records);
    if (records == 0) { return; }
    for_each(exec, "write contact history", contact.candidates.body.size(),
             WriteRecords{contact.contacts(), contact.id.data(), contact.marks.data(), contact.history.key.data(),
                          contact.history.tangential.data()});
    fill_bins(exec, contact.history);
}

template<class Exec, class Real>
void begin_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                const mpm::PagesView& pages, const dem::BodiesView& bodies, const PointBodyLaw& law,
                const SearchReach& reach)
{
    keep_history(exec, contact);
    find_candidates(exec, contact.candidates, points, pages, bodies, law.templates, law.pairs, law.radius, reach);
    resize_to_candidates(contact);
    make_slots(exec, contact, bodies, law);
    copy_numbers(exec, contact, bodies);
    name_runs(exec, contact, bodies.count);
    begin_kept_step(exec, contact, points, law);
    for_each(exec, "recall contacts", contact.candidates.body.size(),
             contact_steps::Recall{contact.contacts(), contact.id.data(), contact.history.view()});
    resize(contact.history, 0); // the slots hold the records from here on
    const auto plane = static_cast<std::size_t>(points.count) * sizeof(Real);
    for (int c = 0; c < 3; ++c) { fill_zero(exec, points.contact_force.data + c * points.contact_force.stride, plane); }
}

template<class Exec, class Real>
void begin_kept_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                     const PointBodyLaw& law)
{
    const PrivatePoints copies = contact.private_points();
    for_each(
        exec, "copy contact points", copies.count,
        contact_steps::CopyPoint<Real>{points, contact.candidates.by_point.view(), law.radius, law.motion, copies});
}

template<class Exec>
void substep(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies, const PointBodyLaw& law,
             double dt)
{
    using namespace contact_steps;
    const ContactsView  contacts = contact.contacts();
    const PrivatePoints points   = contact.private_points();
    const auto          each     = [&]<class EachForce>(const char* name, const EachForce& respond)
    {
        const RunsView parts = contact.candidates.body_parts.of_items.view();
        for_each_run(exec, name, parts,
                     RespondPart<EachForce>{
                         parts, respond, {contacts, points.position, bodies.position}, contact.wrench_sums.data()});
    };
    const Respond respond{contacts, points, bodies, law, dt};
    if (contacts.slot_first == nullptr) { each("point-body forces", respond); }
    else { each("sampled point-body forces", RespondSampled{respond}); }
    for_each(exec, "move contact points", points.count,
             MovePoint{contact.candidates.by_point.view(), contacts, points, law.motion, dt});
}

template<class Exec, class Real>
void finish_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points, double dt)
{
    for_each(exec, "give back impulses", contact.impulse.size(),
             contact_steps::GiveBack<Real>{contact.candidates.by_point.view(), contact.impulse.data(), dt, points});
}

template<class Exec>
void follow_rows(const Exec& exec, PointContact<Exec>& contact, const Array<Exec, std::int32_t>& row,
                 const dem::BodiesView& bodies)
{
    for (Array<Exec, std::int32_t>* of_bodies : {&contact.candidates.body, &contact.candidates.by_body.key})
    {
        for_each(exec, "rows of touched bodies", of_bodies->size(),
                 contact_steps::NewRow{row.data(), of_bodies->data()});
    }
    copy_numbers(exec, contact, bodies);
    name_runs(exec, contact, bodies.count);
}

template<class Exec>
const Summary* summarise(const Exec& exec, PointContact<Exec>& contact, std::int64_t named)
{
    using namespace contact_steps;
    const std::int64_t chunks = contact.summary_sums.size();
    sum_chunks(exec, "summarise contacts", contact.candidates.body.size(), summary_chunk,
               SummaryOf{contact.contacts(), contact.private_points(), named}, contact.summary_sums.data());
    sum_chunks(exec, "summarise contacts", chunks, chunks, LoadSum{contact.summary_sums.data()},
               contact.summary.data());
    contact.dissipated.fill_zero();
    return contact.summary.data();
}

} // namespace tread::contact
