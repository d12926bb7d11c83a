#pragma once

#include "backend/array.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/templates.hpp"

// Whether the list of pairs still holds: a body that is hit within a step may go further than the search allowed for.
namespace tread::dem
{

/// Where bodies stood when their pairs were found, and what the search allowed them.
template<class Exec>
struct Strays
{
    explicit Strays(const Exec& exec)
        : position(exec, "body position at search")
        , orientation(exec, "body orientation at search")
        , allowed(exec, "body travel allowed")
        , share(exec, "body travel shares")
    {
    }

    Array<Exec, Vec3<double>> position;
    Array<Exec, Quat>         orientation;
    Array<Exec, double>       allowed; ///< m
    Array<Exec, double>       share;   ///< of it that was used, by body, and then the largest
};

/// Remembers the bodies as they are, when find_pairs has searched for the next dt (s).
void mark_places(const Cpu&, Strays<Cpu>& strays, const BodiesView& bodies, const TemplateView* templates, double dt);
void mark_places(const Gpu&, Strays<Gpu>& strays, const BodiesView& bodies, const TemplateView* templates, double dt);

/// The largest share of its allowed travel that any point of a body has moved since; strays.share holds all. Up to 1 no
/// pair is missing from the list. Infinite for a body that is nowhere. Waits for the backend.
double largest_stray(const Cpu&, Strays<Cpu>& strays, const BodiesView& bodies, const TemplateView* templates);
double largest_stray(const Gpu&, Strays<Gpu>& strays, const BodiesView& bodies, const TemplateView* templates);

} // namespace tread::dem
