#include "backend/launch.cuh"
#include "kernels/dem/pairs/displacement_tracker_impl.hpp"

namespace tread::dem
{

void mark_places(const Gpu& exec, DisplacementTracker<Gpu>& tracker, const BodiesView& bodies)
{
    displacement_steps::mark(exec, tracker, bodies);
}

const double* largest_displacement(const Gpu& exec, DisplacementTracker<Gpu>& tracker, const BodiesView& bodies,
                                   const TemplateView* templates, const double* travel)
{
    return displacement_steps::largest(exec, tracker, bodies.count,
                                       displacement_steps::measure(tracker, bodies, templates, travel));
}

const double* largest_displacement_ahead(const Gpu& exec, DisplacementTracker<Gpu>& tracker, const BodiesView& bodies,
                                         const TemplateView* templates, const double* travel, double ahead)
{
    const displacement_steps::MeasureAhead item{displacement_steps::measure(tracker, bodies, templates, travel), ahead};
    return displacement_steps::largest(exec, tracker, bodies.count, item);
}

} // namespace tread::dem
