#include "backend/launch.hpp"
#include "kernels/dem/strays_impl.hpp"

namespace tread::dem
{

void mark_places(const Cpu& exec, Strays<Cpu>& strays, const BodiesView& bodies, const TemplateView* templates,
                 double dt)
{
    stray_steps::mark(exec, strays, bodies, templates, dt);
}

double largest_stray(const Cpu& exec, Strays<Cpu>& strays, const BodiesView& bodies, const TemplateView* templates)
{
    return stray_steps::largest(exec, strays, bodies, templates);
}

} // namespace tread::dem
