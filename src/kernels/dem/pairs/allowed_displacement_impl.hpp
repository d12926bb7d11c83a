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
};

/// Maximum speed, m/s, of a body and its neighbours in the previous list. The neighbours of a large body are not
/// searched, because there are too many.
struct FastestNear
{
    std::int64_t        bodies; ///< number of bodies
    const std::int32_t* is_large;
    LastNeighbours      last;
    const double*       speed;

    TREAD_HD double operator()(std::int64_t b) const
    {
        double fastest = speed[b];
        if (last.first == nullptr || is_large[b] != 0) { return fastest; }
        for (std::int32_t p = last.first[b]; p < last.first[b + 1]; ++p)
        {
            const std::int64_t other = second_of(last.key[p]);
            if (other < bodies) { fastest = std::fmax(fastest, speed[other]); }
        }
        for (std::int32_t i = last.second[b]; i < last.second[b + 1]; ++i)
        {
            fastest = std::fmax(fastest, speed[first_of(last.key[last.by_second[i]])]);
        }
        return fastest;
    }
};

/// Computes this rank's share of FastestNear.
struct ShareFastestNear
{
    FastestNear near;
    SharedView  shared;

    TREAD_HD void operator()(std::int64_t i) const { shared.speed[i] = near(shared.body[i]); }
};

struct FastestNearOfAllRanks
{
    FastestNear near;
    SharedView  shared;

    TREAD_HD double operator()(std::int64_t b) const
    {
        return shared.is_shared(b) ? speed_of_all(shared, shared.place[b]) : near(b);
    }
};

/// Computes SearchDisplacement::per_step of a body that is here. Near: FastestNear or FastestNearOfAllRanks.
template<class Near>
struct WritePerStep
{
    BodiesView          bodies;
    const TemplateView* templates;
    double              dt;
    const double*       speed;
    Near                near;
    double*             per_step;
    double*             counted; ///< the same of owned bodies, whose sum over ranks has every body once

    TREAD_HD void operator()(std::int64_t b) const
    {
        per_step[b] = bodies.is_here(b)
                          ? search_displacement(bounding_radius(bodies, templates, b), speed[b], near(b), dt).per_step
                          : 0.0;
        counted[b]  = bodies.is_owned(b) ? per_step[b] : 0.0;
    }
};

template<class Near>
WritePerStep(BodiesView, const TemplateView*, double, const double*, Near, double*, double*) -> WritePerStep<Near>;

struct WriteAllowed
{
    BodiesView          bodies;
    const TemplateView* templates;
    double              dt;
    double              substeps;
    const double*       speed;
    const double*       per_step;
    const double*       sum; ///< sum of `per_step`, of all ranks
    double              all; ///< number of bodies of all ranks
    double*             allowed;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const double radius = bounding_radius(bodies, templates, b);
        const double least  = search_displacement(radius, speed[b], speed[b], dt).least;
        const double steps  = steps_to_last(*sum / all, substeps);
        const double most   = bodies.is_asleep(b) ? most_in_cell : most_additional;
        allowed[b]          = radius * (least + std::fmin(steps * per_step[b], most));
    }
};

template<class Exec>
FastestNear fastest_near(Pairs<Exec>& pairs, const BodiesView& bodies)
{
    const LastNeighbours last{pairs.last.key.data(), pairs.of_body.first.data(), pairs.of_body.by_second.data(),
                              pairs.of_body.second.data()};
    return {bodies.count, pairs.sizes.is_large.data(), last, pairs.displacement.speed.data()};
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
void share_speeds(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const SharedView& shared)
{
    for_each(exec, "share speeds", shared.count,
             pair_steps::ShareFastestNear{pair_steps::fastest_near(pairs, bodies), shared});
}

template<class Exec>
void request_displacement(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                          const SharedView& shared)
{
    using namespace pair_steps;
    pairs.measure.resize(1 + bodies.count);
    double*    counted = pairs.measure.data() + 1;
    const auto write   = [&](const auto& near)
    {
        for_each(exec, "body motion", bodies.count,
                 WritePerStep{bodies, law.templates, dt, pairs.displacement.speed.data(), near,
                              pairs.displacement.per_step.data(), counted});
    };
    if (bodies.role == nullptr) { write(fastest_near(pairs, bodies)); }
    else { write(FastestNearOfAllRanks{fastest_near(pairs, bodies), shared}); }
    sum_rows(exec, counted, bodies.count, 1, pairs.measure.data());
}

template<class Exec>
void allow_displacement(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                        double substeps, std::int64_t all)
{
    for_each(exec, "allowed displacements", bodies.count,
             pair_steps::WriteAllowed{bodies, law.templates, dt, substeps, pairs.displacement.speed.data(),
                                      pairs.displacement.per_step.data(), pairs.measure.data(),
                                      static_cast<double>(all), pairs.displacement.allowed.data()});
}

} // namespace tread::dem
