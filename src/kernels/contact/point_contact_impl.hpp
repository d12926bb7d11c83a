#pragma once

#include "kernels/contact/history_kern.hpp"
#include "kernels/contact/point_contact.hpp"
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

struct Recall
{
    ContactsView         contacts;
    const std::uint32_t* id; ///< of the private points
    HistoryView          history;

    TREAD_HD void operator()(std::int64_t c) const
    {
        const std::uint32_t point = id[contacts.candidates.touched[c]];
        contacts.tangential[c]    = recall(history, history_key(contacts.candidates.body[c], point));
        contacts.response[c]      = no_response();
        contacts.dissipated[c]    = 0.0;
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
        contacts.response[c] = point_body_response(pair(b, t, shape), approach, contacts.tangential[c], dt);
        contacts.dissipated[c] += contacts.response[c].dissipated;
    }
};

struct WrenchOf
{
    ContactsView        contacts;
    const Vec3<double>* point_position;
    const Vec3<double>* body_position;

    TREAD_HD Wrench operator()(std::int64_t c) const
    {
        const Vec3<double> force = -contacts.response[c].force;
        const Vec3<double> arm =
            point_position[contacts.candidates.touched[c]] - body_position[contacts.candidates.body[c]];
        return {force, arm.cross(force), contacts.response[c].stiffness};
    }
};

struct AddToBody
{
    const std::int32_t* touched_body;
    dem::BodiesView     bodies;

    TREAD_HD void operator()(std::int64_t run, const Wrench& sum) const
    {
        const std::int32_t b = touched_body[run];
        bodies.force[b] += sum.force;
        bodies.torque[b] += sum.torque;
        bodies.stiffness[b] += sum.stiffness;
        if (bodies.sand_force == nullptr) { return; }
        bodies.sand_force[b]  = sum.force;
        bodies.sand_torque[b] = sum.torque;
    }
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
    std::int64_t      count;
    const Tangential* tangential;
    std::int32_t*     marks; ///< [count + 1]

    TREAD_HD void operator()(std::int64_t c) const { marks[c] = c < count && tangential[c].force.squaredNorm() > 0; }
};

struct WriteRecords
{
    ContactsView         contacts;
    const std::uint32_t* id;    ///< of the private points
    const std::int32_t*  place; ///< [count + 1], after the scan
    std::uint64_t*       key;
    Tangential*          tangential;

    TREAD_HD void operator()(std::int64_t c) const
    {
        if (place[c + 1] == place[c]) { return; }
        key[place[c]]        = history_key(contacts.candidates.body[c], id[contacts.candidates.touched[c]]);
        tangential[place[c]] = contacts.tangential[c];
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
    resize(contact.candidates.body.size(), contact.tangential, contact.response, contact.dissipated);
    resize(contact.candidates.body_parts.of_items.key.size(), contact.wrench_sums, contact.summary_sums);
    contact.summaries.resize(contact.candidates.by_body.key.size());
}

template<class Exec, class Real>
void begin_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                const mpm::PagesView& pages, const dem::BodiesView& bodies, const PointBodyLaw& law,
                const SearchReach& reach)
{
    find_candidates(exec, contact.candidates, points, pages, bodies, law.templates, law.radius, reach);
    resize_to_candidates(contact);
    const PrivatePoints copies = contact.private_points();
    for_each(
        exec, "copy contact points", copies.count,
        contact_steps::CopyPoint<Real>{points, contact.candidates.by_point.view(), law.radius, law.motion, copies});
    for_each(exec, "recall contacts", contact.tangential.size(),
             contact_steps::Recall{contact.contacts(), copies.id, contact.history.view()});
}

template<class Exec>
void substep(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies, const PointBodyLaw& law,
             double dt)
{
    using namespace contact_steps;
    const ContactsView  contacts = contact.contacts();
    const PrivatePoints points   = contact.private_points();
    const RunsView      by_body  = contact.candidates.by_body.view();
    for_each(exec, "point-body forces", contacts.candidates.count, Respond{contacts, points, bodies, law, dt});
    reduce_parts(exec, "point-body wrenches", by_body, contact.candidates.body_parts, contact.wrench_sums.data(),
                 WrenchOf{contacts, points.position, bodies.position}, AddToBody{by_body.key, bodies});
    for_each(exec, "move contact points", points.count,
             MovePoint{contact.candidates.by_point.view(), contacts, points, law.motion, dt});
}

template<class Exec>
void save_history(const Exec& exec, PointContact<Exec>& contact)
{
    using namespace contact_steps;
    const std::int64_t count   = contact.tangential.size();
    std::int64_t       records = 0;
    if (count > 0)
    {
        contact.marks.resize(count + 1);
        for_each(exec, "mark contact history", count + 1,
                 MarkRecords{count, contact.tangential.data(), contact.marks.data()});
        records = exclusive_scan(exec, contact.marks, contact.candidates.sort);
    }
    resize(contact.history, records);
    if (records == 0) { return; }
    for_each(exec, "write contact history", count,
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
