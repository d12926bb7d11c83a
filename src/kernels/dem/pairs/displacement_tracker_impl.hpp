#pragma once

#include <limits>

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "kernels/dem/pairs/displacement_kern.hpp"
#include "kernels/dem/pairs/displacement_tracker.hpp"

// Steps of displacement_tracker.hpp, for both backends; displacement_tracker.cpp and .cu provide for_each.
namespace tread::dem::displacement_steps
{

/// Measures displacements.
struct Measure
{
    BodiesView          bodies;
    const TemplateView* templates;
    ListedPlaces        listed;
    double*             share;

    TREAD_HD double radius(std::int64_t b) const { return bounding_radius(bodies, templates, b); }

    TREAD_HD double moved(std::int64_t b) const { return displacement_since(bodies, b, listed, listed.age, radius(b)); }

    TREAD_HD void keep(std::int64_t b, double way) const
    {
        if (!bodies.is_owned(b))
        {
            share[b] = 0;
            return;
        }
        const double used = way / listed.allowed.displacement[b];
        share[b]          = used >= 0 ? used : std::numeric_limits<double>::infinity();
    }

    TREAD_HD void operator()(std::int64_t b) const { keep(b, moved(b)); }
};

struct MeasureAhead
{
    Measure measure;
    Ahead   ahead;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const AllowedMotion& allowed = measure.listed.allowed;
        const double more = displacement_ahead(measure.bodies, b, allowed, measure.radius(b), ahead.displacement);
        measure.keep(b, measure.moved(b) + more);
        if (!allowed.drifts(b) || !measure.bodies.is_owned(b)) { return; }
        measure.share[b] =
            std::fmax(measure.share[b], (measure.listed.age + steps_ahead * ahead.drift) / *allowed.span);
    }
};

template<class Exec>
Measure measure(DisplacementTracker<Exec>& tracker, const BodiesView& bodies, const TemplateView* templates,
                const AllowedMotion& allowed, double age)
{
    tracker.share.resize(bodies.count + 1);
    return {bodies, templates, tracker.listed(allowed, age), tracker.share.data()};
}

template<class Exec, class Item>
const double* largest(const Exec& exec, DisplacementTracker<Exec>& tracker, std::int64_t bodies, const Item& item)
{
    for_each(exec, "measure displacements", bodies, item);
    double* found = tracker.share.data() + bodies;
    largest_of_rows(exec, tracker.share.data(), bodies, 1, found);
    return found;
}

} // namespace tread::dem::displacement_steps

namespace tread::dem
{

template<class Exec>
void mark_places(const Exec& exec, DisplacementTracker<Exec>& tracker, const BodiesView& bodies)
{
    const auto count = static_cast<std::size_t>(bodies.count);
    tracker.position.resize(bodies.count);
    tracker.orientation.resize(bodies.count);
    copy(exec, tracker.position.data(), bodies.position, count * sizeof(Vec3<double>));
    copy(exec, tracker.orientation.data(), bodies.orientation, count * sizeof(Quat));
}

template<class Exec>
const double* largest_displacement(const Exec& exec, DisplacementTracker<Exec>& tracker, const BodiesView& bodies,
                                   const TemplateView* templates, const AllowedMotion& allowed, double age)
{
    return displacement_steps::largest(exec, tracker, bodies.count,
                                       displacement_steps::measure(tracker, bodies, templates, allowed, age));
}

template<class Exec>
const double* largest_displacement_ahead(const Exec& exec, DisplacementTracker<Exec>& tracker, const BodiesView& bodies,
                                         const TemplateView* templates, const AllowedMotion& allowed, double age,
                                         const Ahead& ahead)
{
    const displacement_steps::MeasureAhead item{displacement_steps::measure(tracker, bodies, templates, allowed, age),
                                                ahead};
    return displacement_steps::largest(exec, tracker, bodies.count, item);
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void          mark_places(const Exec&, DisplacementTracker<Exec>&, const BodiesView&);                    \
    template const double* largest_displacement(const Exec&, DisplacementTracker<Exec>&, const BodiesView&,            \
                                                const TemplateView*, const AllowedMotion&, double);                    \
    template const double* largest_displacement_ahead(const Exec&, DisplacementTracker<Exec>&, const BodiesView&,      \
                                                      const TemplateView*, const AllowedMotion&, double, const Ahead&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
