#pragma once

#include "backend/reduce.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

// Allowed displacement of each body until the pairs are found again, for both backends. Include after a backend's
// for_each.
namespace tread::dem
{
namespace pair_steps
{

struct WriteSpeed
{
    BodiesView          bodies;
    const TemplateView* templates;
    double*             speed; ///< m/s

    TREAD_HD void operator()(std::int64_t b) const
    {
        speed[b] = bodies.is_here(b) ? speed_of(bodies, b, bounding_radius(bodies, templates, b)) : 0.0;
    }
};

/// The previous list, for the neighbours of each body.
struct LastNeighbours
{
    const std::uint64_t* key;
    const std::int32_t*  first; ///< as in PairsView; null if there was no list
    const std::int32_t*  by_second;
    const std::int32_t*  second;

    /// Calls visit(body or wall) for each neighbour.
    template<class Visit>
    TREAD_HD void each(std::int64_t b, const Visit& visit) const
    {
        for (std::int32_t p = first[b]; p < first[b + 1]; ++p) { visit(second_of(key[p])); }
        for (std::int32_t i = second[b]; i < second[b + 1]; ++i) { visit(first_of(key[by_second[i]])); }
    }
};

/// Speeds of a body and its neighbours in the previous list. The neighbours of a large body are not searched, because
/// there are too many.
struct SpeedsNear
{
    BodiesView          bodies;
    const TemplateView* templates;
    const std::int32_t* is_large;
    LastNeighbours      last;
    const double*       speed;

    TREAD_HD NearSpeeds operator()(std::int64_t b) const
    {
        if (last.first == nullptr || is_large[b] != 0) { return {speed[b], speed[b]}; }
        NearSpeeds near{speed[b], 0};
        last.each(b,
                  [&](std::int64_t other)
                  {
                      const bool wall = other >= bodies.count, along = !wall && is_large[other] == 0;
                      if (!wall) { near.fastest = std::fmax(near.fastest, speed[other]); }
                      near.passing = std::fmax(near.passing, along ? passing(b, other) : speed[b]);
                  });
        return near;
    }

private:
    TREAD_HD double passing(std::int64_t b, std::int64_t other) const
    {
        return (bodies.velocity[other] - bodies.velocity[b]).norm() +
               rim_speed(bodies, other, bounding_radius(bodies, templates, other));
    }
};

/// Computes this rank's shares of NearSpeeds.
struct ShareSpeedsNear
{
    SpeedsNear near;
    SharedView shared;

    TREAD_HD void operator()(std::int64_t i) const { shared.near[i] = near(shared.body[i]); }
};

struct SpeedsNearOnAllRanks
{
    SpeedsNear near;
    SharedView shared;

    TREAD_HD NearSpeeds operator()(std::int64_t b) const
    {
        return shared.is_shared(b) ? near_of_all(shared, shared.place[b]) : near(b);
    }
};

/// A body drifts if it covers at least this share of its bounding radius in a step, and if its velocity differs by at
/// most this share from those of its neighbours.
inline constexpr double least_drift = 0.02, most_wander = 0.3;

/// Chooses the drift of a body that is here, its velocity or none, and computes SearchDisplacement::per_step. Near:
/// SpeedsNear or SpeedsNearOnAllRanks.
template<class Near>
struct WriteMotion
{
    BodiesView          bodies;
    const TemplateView* templates;
    double              dt;
    double              fall; ///< m/s, change of a falling body's velocity that leaves it its drift
    const double*       speed;
    Near                near;
    Vec3<double>*       drift;
    double*             wander;
    double*             per_step;
    double*             counted; ///< the same of owned bodies, whose sum over ranks has every body once

    TREAD_HD void operator()(std::int64_t b) const
    {
        drift[b]  = Vec3<double>::Zero();
        wander[b] = per_step[b] = counted[b] = 0;
        if (!bodies.is_here(b)) { return; }
        const double     radius = bounding_radius(bodies, templates, b);
        const NearSpeeds speeds = near(b);
        const double     beside = speeds.passing + rim_speed(bodies, b, radius) + fall;
        const bool       drifts = speed[b] * dt >= least_drift * radius && beside <= most_wander * speed[b];
        if (drifts) { drift[b] = bodies.velocity[b]; }
        wander[b]   = drifts ? beside : speed[b];
        per_step[b] = search_displacement(radius, wander[b], drifts ? beside : speeds.fastest, dt).per_step;
        if (bodies.is_owned(b)) { counted[b] = per_step[b]; }
    }
};

template<class Near>
WriteMotion(BodiesView, const TemplateView*, double, double, const double*, Near, Vec3<double>*, double*, double*,
            double*) -> WriteMotion<Near>;

struct WriteAllowed
{
    BodiesView          bodies;
    const TemplateView* templates;
    double              dt;
    double              substeps;
    const double*       wander;
    const double*       per_step;
    const double*       sum; ///< sum of `per_step`, of all ranks
    double              all; ///< number of bodies of all ranks
    double*             allowed;
    double*             span; ///< AllowedMotion::span

    TREAD_HD void operator()(std::int64_t b) const
    {
        const double             radius = bounding_radius(bodies, templates, b);
        const SearchDisplacement own    = search_displacement(radius, wander[b], wander[b], dt);
        // Hit within the next step by the fastest of its neighbours, a body goes this much farther than by itself.
        const double hit   = per_step[b] - own.per_step;
        const double steps = steps_to_last(*sum / all, substeps);
        allowed[b]         = radius * (own.least + std::fmin(std::fmax(steps * per_step[b], hit), most_per_step));
        if (b == 0) { *span = (steps_ahead + steps) * dt; }
    }
};

template<class Exec>
SpeedsNear speeds_near(Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    const LastNeighbours last{pairs.last.key.data(), pairs.of_body.first.data(), pairs.of_body.by_second.data(),
                              pairs.of_body.second.data()};
    return {bodies, law.templates, pairs.sizes.is_large.data(), last, pairs.displacement.speed.data()};
}

template<class Exec>
void write_speeds(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    pairs.displacement.allowed.resize(bodies.count);
    pairs.displacement.speed.resize(bodies.count);
    pairs.displacement.per_step.resize(bodies.count);
    for_each(exec, "body speeds", bodies.count, WriteSpeed{bodies, law.templates, pairs.displacement.speed.data()});
}

} // namespace pair_steps

template<class Exec>
void share_speeds(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law,
                  const SharedView& shared)
{
    for_each(exec, "share speeds", shared.count,
             pair_steps::ShareSpeedsNear{pair_steps::speeds_near(pairs, bodies, law), shared});
}

template<class Exec>
void request_displacement(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                          double gravity, const SharedView& shared)
{
    using namespace pair_steps;
    AllowedDisplacement<Exec>& displacement = pairs.displacement;
    displacement.drift.resize(bodies.count);
    displacement.wander.resize(bodies.count);
    displacement.drifting = true; // until fill_cells knows
    pairs.measure.resize(1 + bodies.count);
    double*    counted = pairs.measure.data() + 1;
    const auto write   = [&](const auto& near)
    {
        for_each(exec, "body motion", bodies.count,
                 WriteMotion{bodies, law.templates, dt, 2 * dt * gravity, displacement.speed.data(), near,
                             displacement.drift.data(), displacement.wander.data(), displacement.per_step.data(),
                             counted});
    };
    if (bodies.role == nullptr) { write(speeds_near(pairs, bodies, law)); }
    else { write(SpeedsNearOnAllRanks{speeds_near(pairs, bodies, law), shared}); }
    sum_rows(exec, counted, bodies.count, 1, pairs.measure.data());
}

template<class Exec>
void allow_displacement(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                        double substeps, std::int64_t all)
{
    for_each(exec, "allowed displacements", bodies.count,
             pair_steps::WriteAllowed{bodies, law.templates, dt, substeps, pairs.displacement.wander.data(),
                                      pairs.displacement.per_step.data(), pairs.measure.data(),
                                      static_cast<double>(all), pairs.displacement.allowed.data(),
                                      pairs.displacement.span.data()});
}

} // namespace tread::dem
