#include "backend/launch.cuh"
#include "kernels/dem/pairs/strays_impl.hpp"

namespace tread::dem
{

void mark_places(const Gpu& exec, Strays<Gpu>& strays, const BodiesView& bodies)
{
    stray_steps::mark(exec, strays, bodies);
}

const double* largest_stray(const Gpu& exec, Strays<Gpu>& strays, const BodiesView& bodies,
                            const TemplateView* templates, const double* travel)
{
    return stray_steps::largest(exec, strays, bodies.count, stray_steps::measure(strays, bodies, templates, travel));
}

const double* largest_stray_ahead(const Gpu& exec, Strays<Gpu>& strays, const BodiesView& bodies,
                                  const TemplateView* templates, const double* travel, double ahead)
{
    const stray_steps::MeasureAhead item{stray_steps::measure(strays, bodies, templates, travel), ahead};
    return stray_steps::largest(exec, strays, bodies.count, item);
}

} // namespace tread::dem
