#pragma once

#include "kernels/contact/entered_side_kern.hpp"
#include "kernels/contact/history_kern.hpp"
#include "kernels/contact/point_contact.hpp"
#include "kernels/contact/samples_kern.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"
#include "kernels/dem/motion/move_impl.hpp"

// Item functions of a sand-body contact step for a point, candidate, part or body.
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

    TREAD_HD void operator()(std::int64_t t) const { take(t, runs.key[t]); }

    /// Copies point p.
    TREAD_HD void take(std::int64_t t, std::int64_t p) const
    {
        copy.position[t] = points.position.get(p);
        copy.velocity[t] = points.grid_velocity.get(p).template cast<double>();
        copy.support[t]  = Vec3<double>::Zero();
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

/// Returns the key of slot s of candidate c.
TREAD_HD std::uint64_t slot_key(const ContactsView& contacts, const std::uint32_t* id, std::int64_t c, std::int64_t s)
{
    const std::int64_t first = contacts.first_slot(c);
    const bool         alone = contacts.first_slot(c + 1) == first + 1;
    return history_key(contacts.body_number(c), id[contacts.candidates.touched[c]],
                       alone ? 0 : static_cast<int>(s - first) + 1);
}

struct NewRow
{
    const std::int32_t* row; ///< now, of each row before
    std::int32_t*       of;

    TREAD_HD void operator()(std::int64_t i) const { of[i] = row[of[i]]; }
};

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

/// Returns the velocity of the body's material at x.
TREAD_HD Vec3<double> velocity_at(const dem::BodiesView& bodies, std::int32_t b, const Vec3<double>& x)
{
    return bodies.velocity[b] + bodies.angular_velocity[b].cross(x - bodies.position[b]);
}

/// Returns a unit vector turned with the body for dt (s).
TREAD_HD Vec3<double> turned_with_body(const Vec3<double>& direction, const Vec3<double>& angular_velocity, double dt)
{
    const Vec3<double> turned = direction + dt * angular_velocity.cross(direction);
    return turned / turned.norm();
}

/// Computes the response of body b to a point at x with velocity v (m, m/s); advances `tangential` by dt (s).
TREAD_HD Response response_of(const dem::BodiesView& bodies, std::int32_t b, const dem::TemplateView& shape,
                              const PairConstants& pair, const Vec3<double>& x, const Vec3<double>& v,
                              Tangential& tangential, double dt)
{
    const auto sdf = [&](const Vec3<double>& at)
    { return dem::sample_body_sdf(shape, bodies.scale[b], bodies.position[b], bodies.orientation[b], at); };
    dem::SdfSample field = sdf(x);
    if (field.distance < 0 && field.gradient.dot(tangential.normal) < same_side && is_known(tangential.normal))
    {
        const Vec3<double> side = turned_with_body(tangential.normal, bodies.angular_velocity[b], dt);
        field =
            entered_side(field, side, pair.point_radius, [&](const Vec3<double>& offset) { return sdf(x + offset); });
    }
    const Vec3<double> surface = x - stand_off(field.distance, field.gradient);
    const Approach     approach{field.distance, field.gradient, v - velocity_at(bodies, b, surface)};
    return point_body_response(pair, approach, tangential, dt);
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
        contacts.response[c] = response_of(bodies, b, shape, pair(b, t, shape), points.position[t], points.velocity[t],
                                           contacts.tangential[contacts.first_slot(c)], dt);
        contacts.dissipated[c] += contacts.response[c].dissipated;
    }
};

/// Computes the responses if some bodies are sampled.
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
            sampled_response(pair, x - bodies.position[b], respond.points.velocity[t] - velocity_at(bodies, b, x),
                             bodies.angular_velocity[b], sdf, bound, contacts.tangential + first, respond.dt);
        contacts.dissipated[c] += contacts.response[c].dissipated;
    }
};

/// Returns the wrench on the body from the response at `arm` from the body's centre (m).
TREAD_HD dem::ContactWrench wrench_on_body(const Response& response, const Vec3<double>& arm)
{
    const Vec3<double> force = -response.force;
    return {force, arm.cross(force) + response.couple, response.stiffness};
}

struct WrenchOf
{
    ContactsView        contacts;
    const Vec3<double>* point_position;
    const Vec3<double>* body_position;

    TREAD_HD dem::ContactWrench operator()(std::int64_t c) const
    {
        const Vec3<double> arm =
            point_position[contacts.candidates.touched[c]] - body_position[contacts.candidates.body[c]];
        return wrench_on_body(contacts.response[c], arm);
    }
};

/// Computes the forces of a part's candidates and their sum. EachForce: Respond or RespondSampled.
template<class EachForce>
struct RespondPart
{
    RunsView            parts;
    EachForce           respond;
    WrenchOf            wrench;
    dem::ContactWrench* sums;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t part, const Lanes& lanes) const
    {
        dem::ContactWrench sum = dem::ContactWrench::zero();
        for (std::int64_t c = parts.first[part] + lanes.lane(); c < parts.first[part + 1]; c += lanes.lanes())
        {
            respond(c);
            sum = sum + wrench(c);
        }
        dem::moving::reduce(sum, lanes);
        if (lanes.lane() == 0) { sums[part] = sum; }
    }
};

/// Writes the run of each touched body.
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

/// State and external influences of a private point while it moves.
struct MovingPoint
{
    Vec3<double> position;
    Vec3<double> velocity;
    Vec3<double> impulse;
    Vec3<double> support;
    double       mass;

    /// Symplectic Euler step under a contact force (N), by dt (s).
    TREAD_HD void move(const Vec3<double>& force, PointMotion motion, double dt)
    {
        impulse += dt * force;
        if (motion == PointMotion::frozen) { return; }
        velocity += dt * (force / mass + support);
        position += dt * velocity;
    }
};

TREAD_HD MovingPoint moving_point(const PrivatePoints& points, std::int64_t t)
{
    return {points.position[t], points.velocity[t], points.impulse[t], points.support[t], points.mass[t]};
}

TREAD_HD void store(const MovingPoint& point, const PrivatePoints& points, std::int64_t t)
{
    points.position[t] = point.position;
    points.velocity[t] = point.velocity;
    points.impulse[t]  = point.impulse;
}

/// Moves a point under the contact forces of all bodies, summed in body order.
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
        MovingPoint point = moving_point(points, t);
        point.move(force, motion, dt);
        store(point, points, t);
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

    TREAD_HD void operator()(std::int64_t s) const { marks[s] = s < slots && is_known(tangential[s].normal); }
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
    std::int64_t  named; ///< number of named bodies (the first ones), whose contacts are counted separately

    TREAD_HD Summary operator()(std::int64_t c) const
    {
        const Response& response = contacts.response[c];
        Summary         summary  = Summary::zero();
        summary.dissipated       = contacts.dissipated[c];
        if (!(response.overlap > 0)) { return summary; }
        const std::int32_t  b = contacts.body_number(c), t = contacts.candidates.touched[c];
        const std::uint32_t id = points.id[t];
        summary.live           = 1;
        summary.live_named     = b < named ? 1 : 0;
        summary.energy         = response.energy;
        summary.stiffest       = {response.stiffness / points.mass[t], b, id};
        summary.deepest        = {response.overlap / points.radius[t], b, id};
        if (response.overlap > points.radius[t]) { summary.flattest = {response.gradient_length, b, id}; }
        return summary;
    }
};

struct LoadSum
{
    const Summary* sums;

    TREAD_HD Summary operator()(std::int64_t chunk) const { return sums[chunk]; }
};

} // namespace contact_steps

} // namespace tread::contact
