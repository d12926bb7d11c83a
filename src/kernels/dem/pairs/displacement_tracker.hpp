#pragma once

#include "backend/array.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/templates.hpp"

// Whether the list of pairs still holds: a body that is hit within a step may go further than the search allowed for.
namespace tread::dem
{

/// Where bodies stood when their pairs were found.
template<class Exec>
struct DisplacementTracker
{
    explicit DisplacementTracker(const Exec& exec)
        : position(exec, "body position at search")
        , orientation(exec, "body orientation at search")
        , share(exec, "body travel shares")
    {
    }

    Array<Exec, Vec3<double>> position;
    Array<Exec, Quat>         orientation;
    Array<Exec, double>       share; ///< of its allowed travel that each body used, and then the largest
};

/// Remembers the bodies as they are, after find_pairs.
void mark_places(const Cpu&, DisplacementTracker<Cpu>& tracker, const BodiesView& bodies);
void mark_places(const Gpu&, DisplacementTracker<Gpu>& tracker, const BodiesView& bodies);

/// The largest share of its allowed travel (m, of every body) that any point of a body has moved since; tracker.share
/// holds all. Up to 1 no pair is missing from the list. Infinite for a body that is nowhere. Returns where the backend
/// will have it.
const double* largest_displacement(const Cpu&, DisplacementTracker<Cpu>& tracker, const BodiesView& bodies,
                                   const TemplateView* templates, const double* travel);
const double* largest_displacement(const Gpu&, DisplacementTracker<Gpu>& tracker, const BodiesView& bodies,
                                   const TemplateView* templates, const double* travel);

/// The same when the bodies go on for the steps ahead of `ahead` (s), and with what must be left for a body at rest.
const double* largest_displacement_ahead(const Cpu&, DisplacementTracker<Cpu>& tracker, const BodiesView& bodies,
                                         const TemplateView* templates, const double* travel, double ahead);
const double* largest_displacement_ahead(const Gpu&, DisplacementTracker<Gpu>& tracker, const BodiesView& bodies,
                                         const TemplateView* templates, const double* travel, double ahead);

} // namespace tread::dem
