#pragma once

#include "kernels/contact/history_kern.hpp"
#include "kernels/contact/point_contact.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "kernels/dem/sdf_kern.hpp"

// The steps of the sand-body contact, the same on both backends; point_contact.cpp and point_contact.cu bring in
// for_each and reduce_runs, and instantiate.
namespace tread::contact
{
namespace contact_steps
{

template<class Real>
struct CopyPoint
{
    mpm::PointsView<Real> points;
    RunsView              runs;
    RadiusRule            radius;
    PointMotion           motion;
    PrivatePoints         copy;

    TREAD_HD void operator()(std::int64_t t) const
    {
        const std::int32_t p = runs.key[t];
        copy.position[t]     = points.position.get(p);
        copy.velocity[t]     = points.grid_velocity.get(p).template cast<double>();
        copy.support[t]      = Vec3<double>::Zero();
        if (motion == PointMotion::supported) { copy.support[t] = points.support.get(p).template cast<double>(); }
        copy.impulse[t]  = Vec3<double>::Zero();
        copy.mass[t]     = static_cast<double>(points.mass[p]);
        copy.radius[t]   = point_radius(static_cast<double>(points.volume[p]), radius);
        copy.material[t] = points.material[p];
        copy.id[t]       = points.id[p];
    }
};

struct CountSlots
{
    CandidatesView           candidates;
    dem::BodiesView          bodies;
    const dem::TemplateView* templates;
    double                   sampled_below;
    std::int32_t*            slots; ///< [count + 1]

    TREAD_HD void operator()(std::int64_t c) const
    {
        slots[c] = 0;
        if (c == candidates.count) { return; }
        const std::int32_t b       = candidates.body[c];
        const bool         sampled = takes_samples(templates[bodies.shape[b]], bodies.scale[b], sampled_below);
        slots[c]                   = sampled ? patch_samples : 1;
    }
};

/// Key of slot s of candidate c.
TREAD_HD std::uint64_t slot_key(const ContactsView& contacts, const std::uint32_t* id, std::int64_t c, std::int64_t s)
{
    const std::int64_t first = contacts.first_slot(c);
    const bool         alone = contacts.first_slot(c + 1) == first + 1;
    return history_key(contacts.candidates.body[c], id[contacts.candidates.touched[c]],
                       alone ? 0 : static_cast<int>(s - first) + 1);
}

struct Recall
{
    ContactsView         contacts;
    const std::uint32_t* id; ///< of the private points
    HistoryView          history;

    TREAD_HD void operator()(std::int64_t c) const
    {
        for (std::int64_t s = contacts.first_slot(c); s < contacts.first_slot(c + 1); ++s)
        {
            contacts.tangential[s] = recall(history, slot_key(contacts, id, c, s));
        }
        contacts.response[c]   = no_response();
        contacts.dissipated[c] = 0.0;
    }
};

/// Velocity of the body's material at x.
TREAD_HD Vec3<double> velocity_at(const dem::BodiesView& bodies, std::int32_t b, const Vec3<double>& x)
{
    return bodies.velocity[b] + bodies.angular_velocity[b].cross(x - bodies.position[b]);
}

struct Respond
{
    ContactsView    contacts;
    PrivatePoints   points;
    dem::BodiesView bodies;
    PointBodyLaw    law;
    double          dt;

    TREAD_HD PairConstants pair(std::int32_t b, std::int32_t t, const dem::TemplateView& shape) const
    {
        const dem::PairProperties& found = law.pairs(points.material[t], bodies.material[b]);
        return {found.effective_young, found.effective_shear,
                found.friction,        law.hertz_factor,
                points.radius[t],      effective_radius(points.radius[t], shape.equivalent_radius * bodies.scale[b])};
    }

    TREAD_HD void operator()(std::int64_t c) const
    {
        const std::int32_t       b     = contacts.candidates.body[c];
        const std::int32_t       t     = contacts.candidates.touched[c];
        const dem::TemplateView& shape = law.templates[bodies.shape[b]];
        const Vec3<double>       x     = points.position[t];

        const auto field = dem::sample_body_sdf(shape, bodies.scale[b], bodies.position[b], bodies.orientation[b], x);
        const Approach approach{field.distance, field.gradient, points.velocity[t] - velocity_at(bodies, b, x)};
        Tangential&    tangential = contacts.tangential[contacts.first_slot(c)];
        contacts.response[c]      = point_body_response(pair(b, t, shape), approach, tangential, dt);
        contacts.dissipated[c] += contacts.response[c].dissipated;
    }
};

/// The same where some bodies are sampled.
struct RespondSampled
{
    Respond respond;

    TREAD_HD void operator()(std::int64_t c) const
    {
        const ContactsView& contacts = respond.contacts;
        const std::int64_t  first    = contacts.first_slot(c);
        if (contacts.first_slot(c + 1) == first + 1)
        {
            respond(c);
            return;
        }
        const dem::BodiesView&   bodies = respond.bodies;
        const std::int32_t       b      = contacts.candidates.body[c];
        const std::int32_t       t      = contacts.candidates.touched[c];
        const dem::TemplateView& shape  = respond.law.templates[bodies.shape[b]];
        const PairConstants      pair   = respond.pair(b, t, shape);
        const Vec3<double>       x      = respond.points.position[t];

        const auto sdf = [&](const Vec3<double>& offset)
        { return dem::sample_body_sdf(shape, bodies.scale[b], bodies.position[b], bodies.orientation[b], x + offset); };
        const double bound =
            dem::search_bound(shape, bodies.scale[b], pair.point_radius, 2.0 * patch_reach * pair.point_radius);
        contacts.response[c] =
            sampled_response(pair, x - bodies.position[b], respond.points.velocity[t] - velocity_at(bodies, b, x), sdf,
                             bound, contacts.tangential + first, respond.dt);
        contacts.dissipated[c] += contacts.response[c].dissipated;
    }
};

struct WrenchOf
{
    ContactsView        contacts;
    const Vec3<double>* point_position;
    const Vec3<double>* body_position;

    TREAD_HD dem::ContactWrench operator()(std::int64_t c) const
    {
        const Vec3<double> force = -contacts.response[c].force;
        const Vec3<double> arm =
            point_position[contacts.candidates.touched[c]] - body_position[contacts.candidates.body[c]];
        return {force, arm.cross(force), contacts.response[c].stiffness};
    }
};

/// Of each touched body.
struct NameRun
{
    const std::int32_t* touched_body;
    std::int32_t*       run_of_body;

    TREAD_HD void operator()(std::int64_t run) const
    {
        run_of_body[touched_body[run]] = static_cast<std::int32_t>(run);
    }
};

struct NoRun
{
    std::int32_t* run_of_body;

    TREAD_HD void operator()(std::int64_t b) const { run_of_body[b] = -1; }
};

/// Symplectic Euler under the contact forces of all bodies, summed in body order.
struct MovePoint
{
    RunsView      runs;
    ContactsView  contacts;
    PrivatePoints points;
    PointMotion   motion;
    double        dt;

    TREAD_HD void operator()(std::int64_t t) const
    {
        Vec3<double> force = Vec3<double>::Zero();
        for (std::int32_t i = runs.first[t]; i < runs.first[t + 1]; ++i)
        {
            force += contacts.response[contacts.candidates.in_order[i]].force;
        }
        points.impulse[t] += dt * force;
        if (motion == PointMotion::frozen) { return; }
        points.velocity[t] += dt * (force / points.mass[t] + points.support[t]);
        points.position[t] += dt * points.velocity[t];
    }
};

template<class Real>
struct GiveBack
{
    RunsView              runs;
    const Vec3<double>*   impulse;
    double                dt;
    mpm::PointsView<Real> points;

    TREAD_HD void operator()(std::int64_t t) const
    {
        points.contact_force.set(runs.key[t], (impulse[t] / dt).template cast<Real>());
    }
};

struct MarkRecords
{
    std::int64_t      slots;
    const Tangential* tangential;
    std::int32_t*     marks; ///< [slots + 1]

    TREAD_HD void operator()(std::int64_t s) const { marks[s] = s < slots && tangential[s].force.squaredNorm() > 0; }
};

struct WriteRecords
{
    ContactsView         contacts;
    const std::uint32_t* id;    ///< of the private points
    const std::int32_t*  place; ///< [slots + 1], after the scan
    std::uint64_t*       key;
    Tangential*          tangential;

    TREAD_HD void operator()(std::int64_t c) const
    {
        for (std::int64_t s = contacts.first_slot(c); s < contacts.first_slot(c + 1); ++s)
        {
            if (place[s + 1] == place[s]) { continue; }
            key[place[s]]        = slot_key(contacts, id, c, s);
            tangential[place[s]] = contacts.tangential[s];
        }
    }
};

struct SummaryOf
{
    ContactsView  contacts;
    PrivatePoints points;

    TREAD_HD Summary operator()(std::int64_t c) const
    {
        const Response& response = contacts.response[c];
        Summary         summary  = Summary::zero();
        summary.dissipated       = contacts.dissipated[c];
        if (!(response.overlap > 0)) { return summary; }
        const std::int32_t  b = contacts.candidates.body[c], t = contacts.candidates.touched[c];
        const std::uint32_t id = points.id[t];
        summary.live           = 1;
        summary.energy         = response.energy;
        summary.stiffest       = {response.stiffness / points.mass[t], b, id};
        summary.deepest        = {response.overlap / points.radius[t], b, id};
        if (response.overlap > points.radius[t]) { summary.flattest = {response.gradient_length, b, id}; }
        return summary;
    }
};

} // namespace contact_steps

/// Memory for the candidates found.
template<class Exec>
void resize_to_candidates(PointContact<Exec>& contact)
{
    const auto resize = [](std::int64_t size, auto&... arrays) { (arrays.resize(size), ...); };
    resize(contact.candidates.by_point.key.size(), contact.position, contact.velocity, contact.support, contact.impulse,
           contact.mass, contact.radius, contact.material, contact.id);
    resize(contact.candidates.body.size(), contact.response, contact.dissipated);
    resize(contact.candidates.body_parts.of_items.key.size(), contact.wrench_sums, contact.summary_sums);
    contact.summaries.resize(contact.candidates.by_body.key.size());
}

/// Memory for the history of the candidates found.
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

/// Of each body, where its wrenches will be.
template<class Exec>
void name_runs(const Exec& exec, PointContact<Exec>& contact, std::int64_t bodies)
{
    if (contact.candidates.body.size() == 0) { return; }
    contact.run_of_body.resize(bodies);
    for_each(exec, "bodies without sand", bodies, contact_steps::NoRun{contact.run_of_body.data()});
    const RunsView by_body = contact.candidates.by_body.view();
    for_each(exec, "bodies in sand", by_body.count, contact_steps::NameRun{by_body.key, contact.run_of_body.data()});
}

template<class Exec, class Real>
void begin_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                const mpm::PagesView& pages, const dem::BodiesView& bodies, const PointBodyLaw& law,
                const SearchReach& reach)
{
    find_candidates(exec, contact.candidates, points, pages, bodies, law.templates, law.radius, reach);
    resize_to_candidates(contact);
    make_slots(exec, contact, bodies, law);
    name_runs(exec, contact, bodies.count);
    const PrivatePoints copies = contact.private_points();
    for_each(
        exec, "copy contact points", copies.count,
        contact_steps::CopyPoint<Real>{points, contact.candidates.by_point.view(), law.radius, law.motion, copies});
    for_each(exec, "recall contacts", contact.candidates.body.size(),
             contact_steps::Recall{contact.contacts(), copies.id, contact.history.view()});
}

template<class Exec>
void substep(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies, const PointBodyLaw& law,
             double dt)
{
    using namespace contact_steps;
    const ContactsView  contacts = contact.contacts();
    const PrivatePoints points   = contact.private_points();
    const Respond       respond{contacts, points, bodies, law, dt};
    if (contacts.slot_first == nullptr) { for_each(exec, "point-body forces", contacts.candidates.count, respond); }
    else { for_each(exec, "sampled point-body forces", contacts.candidates.count, RespondSampled{respond}); }
    reduce_runs<dem::ContactWrench>(exec, "point-body wrenches", contact.candidates.body_parts.of_items.view(),
                                    WrenchOf{contacts, points.position, bodies.position},
                                    run_steps::StoreSum<dem::ContactWrench>{contact.wrench_sums.data()});
    for_each(exec, "move contact points", points.count,
             MovePoint{contact.candidates.by_point.view(), contacts, points, law.motion, dt});
}

template<class Exec>
void save_history(const Exec& exec, PointContact<Exec>& contact)
{
    using namespace contact_steps;
    const std::int64_t slots   = contact.tangential.size();
    std::int64_t       records = 0;
    if (slots > 0)
    {
        contact.marks.resize(slots + 1);
        for_each(exec, "mark contact history", slots + 1,
                 MarkRecords{slots, contact.tangential.data(), contact.marks.data()});
        records = exclusive_scan(exec, contact.marks, contact.candidates.sort);
    }
    resize(contact.history, records);
    if (records == 0) { return; }
    for_each(exec, "write contact history", contact.candidates.body.size(),
             WriteRecords{contact.contacts(), contact.id.data(), contact.marks.data(), contact.history.key.data(),
                          contact.history.tangential.data()});
    fill_bins(exec, contact.history);
}

template<class Exec, class Real>
void finish_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points, double dt)
{
    const auto plane = static_cast<std::size_t>(points.count) * sizeof(Real);
    for (int c = 0; c < 3; ++c) { fill_zero(exec, points.contact_force.data + c * points.contact_force.stride, plane); }
    for_each(exec, "give back impulses", contact.impulse.size(),
             contact_steps::GiveBack<Real>{contact.candidates.by_point.view(), contact.impulse.data(), dt, points});
    save_history(exec, contact);
}

template<class Exec>
Summary summarise(const Exec& exec, PointContact<Exec>& contact)
{
    using namespace contact_steps;
    reduce_parts(exec, "summarise contacts", contact.candidates.by_body.view(), contact.candidates.body_parts,
                 contact.summary_sums.data(), SummaryOf{contact.contacts(), contact.private_points()},
                 run_steps::StoreSum<Summary>{contact.summaries.data()});
    Summary total = Summary::zero();
    for (const Summary& body : contact.summaries.to_host()) { total = total + body; }
    return total;
}

} // namespace tread::contact
