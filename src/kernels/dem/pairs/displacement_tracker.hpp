#pragma once

#include "backend/array.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/templates.hpp"

// Checks that the list of pairs is still valid: a body that is hit within a step may be displaced further than the
// search allowed.
namespace tread::dem
{

/// Positions of the bodies when their pairs were found.
template<class Exec>
struct DisplacementTracker
{
    explicit DisplacementTracker(const Exec& exec)
        : position(exec, "body position at search")
        , orientation(exec, "body orientation at search")
        , share(exec, "body displacement shares")
    {
    }

    /// `age`: s, since mark_places.
    ListedPlaces listed(const AllowedMotion& allowed, double age = 0) const
    {
        return {position.data(), orientation.data(), allowed, age};
    }

    Array<Exec, Vec3<double>> position;
    Array<Exec, Quat>         orientation;
    Array<Exec, double>       share; ///< share of its allowed displacement that each body used, followed by the maximum
};

/// Stores the present positions of the bodies; call after find_pairs.
template<class Exec>
void mark_places(const Exec& exec, DisplacementTracker<Exec>& tracker, const BodiesView& bodies);

/// Computes the displacement of every body's furthest point since mark_places as a share of what the list allows it,
/// and its maximum; tracker.share holds all. No pair is missing from the list while the maximum is at most 1. It is
/// infinite for a body without a finite position. `age`: s, since mark_places. Returns the address of the maximum in
/// the backend's memory.
template<class Exec>
const double* largest_displacement(const Exec& exec, DisplacementTracker<Exec>& tracker, const BodiesView& bodies,
                                   const TemplateView* templates, const AllowedMotion& allowed, double age);

/// Part of the coming steps (s each) that a look ahead covers.
struct Ahead
{
    double displacement; ///< for which displacements are extrapolated
    double drift;        ///< for which bodies must still be allowed to drift
};

/// Computes the same share with the displacement extrapolated over the coming steps, plus a reserve for bodies at rest;
/// for a body that drifts, at least the share of the time for which it may.
template<class Exec>
const double* largest_displacement_ahead(const Exec& exec, DisplacementTracker<Exec>& tracker, const BodiesView& bodies,
                                         const TemplateView* templates, const AllowedMotion& allowed, double age,
                                         const Ahead& ahead);

} // namespace tread::dem
