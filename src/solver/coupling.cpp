#include "solver/coupling.hpp"

#include <algorithm>

#include "solver/materials.hpp"

namespace tread::solver
{

template<class Exec, class Real>
Coupling<Exec, Real>::Coupling(const Exec& exec, const scene::Scene& scene, const World& world,
                               const dem::TemplateView* templates, dem::PairTable pairs)
    : exec_(exec)
    , contact_(exec)
    , law_{templates, pairs, hertz_factor(scene.numerics.hertz), radius_rule(scene.numerics.point_radius),
           point_motion(scene.numerics.point_motion)}
    , largest_radius_(
          contact::point_radius(*std::max_element(world.points.volume.begin(), world.points.volume.end()), law_.radius))
{
}

template<class Exec, class Real>
void Coupling<Exec, Real>::begin_step(const mpm::PointsView<Real>& points, const mpm::PagesView& pages,
                                      const dem::BodiesView& bodies, double dt, double speed)
{
    const double drift = mpm::quadratic_cell_slack * pages.spacing;
    contact::begin_step(exec_, contact_, points, pages, bodies, law_, {dt, speed, drift, largest_radius_});
}

template<class Exec, class Real>
void Coupling<Exec, Real>::substep(const dem::BodiesView& bodies, double dt)
{
    contact::substep(exec_, contact_, bodies, law_, dt);
}

template<class Exec, class Real>
void Coupling<Exec, Real>::finish_step(const mpm::PointsView<Real>& points, double dt)
{
    contact::finish_step(exec_, contact_, points, dt);
    summary_ = contact::summarise(exec_, contact_);
}

template class Coupling<Cpu, float>;
template class Coupling<Cpu, double>;
#ifdef TREAD_WITH_CUDA
template class Coupling<Gpu, float>;
template class Coupling<Gpu, double>;
#endif

} // namespace tread::solver
