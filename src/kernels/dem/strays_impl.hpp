#pragma once

#include <limits>

#include "backend/reduce.hpp"
#include "kernels/dem/pairs_kern.hpp"
#include "kernels/dem/strays.hpp"

// The steps of strays.hpp, the same on both backends; strays.cpp and strays.cu bring in for_each.
namespace tread::dem::stray_steps
{

struct Mark
{
    BodiesView          bodies;
    const TemplateView* templates;
    double              dt;
    Vec3<double>*       position;
    Quat*               orientation;
    double*             allowed;

    TREAD_HD void operator()(std::int64_t b) const
    {
        position[b]    = bodies.position[b];
        orientation[b] = bodies.orientation[b];
        allowed[b]     = reach_of(bodies, templates, b, dt).travel;
    }
};

/// A turn by the angle t moves no point further than 2 sin(t/2) of the bounding radius; a quaternion's vector part is
/// sin(t/2) long.
struct Measure
{
    BodiesView          bodies;
    const TemplateView* templates;
    const Vec3<double>* position;
    const Quat*         orientation;
    const double*       allowed;
    double*             share;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const double radius = templates[bodies.shape[b]].bounding_radius * bodies.scale[b];
        const double turned = (bodies.orientation[b] * orientation[b].conjugate()).vec().norm();
        const double moved  = (bodies.position[b] - position[b]).norm() + 2.0 * turned * radius;
        const double used   = moved / allowed[b];
        share[b]            = used >= 0 ? used : std::numeric_limits<double>::infinity();
    }
};

template<class Exec>
void mark(const Exec& exec, Strays<Exec>& strays, const BodiesView& bodies, const TemplateView* templates, double dt)
{
    strays.position.resize(bodies.count);
    strays.orientation.resize(bodies.count);
    strays.allowed.resize(bodies.count);
    for_each(exec, "mark places", bodies.count,
             Mark{bodies, templates, dt, strays.position.data(), strays.orientation.data(), strays.allowed.data()});
}

template<class Exec>
double largest(const Exec& exec, Strays<Exec>& strays, const BodiesView& bodies, const TemplateView* templates)
{
    strays.share.resize(bodies.count + 1);
    for_each(exec, "measure strays", bodies.count,
             Measure{bodies, templates, strays.position.data(), strays.orientation.data(), strays.allowed.data(),
                     strays.share.data()});
    double* found = strays.share.data() + bodies.count;
    largest_of_rows(exec, strays.share.data(), bodies.count, 1, found);
    return read(exec, found);
}

} // namespace tread::dem::stray_steps
