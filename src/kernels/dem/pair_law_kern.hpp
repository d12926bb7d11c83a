#pragma once

#include "kernels/dem/pairs.hpp"

namespace tread::dem
{

/// A body with every freedom locked is as heavy as a wall.
TREAD_HD double inverse_mass(const BodiesView& bodies, std::int64_t b)
{
    return bodies.locked[b] == lock_all ? 0.0 : 1.0 / bodies.mass[b];
}

TREAD_HD double equivalent_radius(const BodiesView& bodies, const TemplateView* templates, std::int64_t b)
{
    return templates[bodies.shape[b]].equivalent_radius * bodies.scale[b];
}

/// Of a listed pair. Against a wall R* is the body's own radius, and a slip wall has no friction.
TREAD_HD PairLaw law_of(const BodiesView& bodies, const BodyLaw& law, std::uint64_t key)
{
    const std::int64_t a = first_of(key), b = second_of(key);
    const bool         wall           = b >= bodies.count;
    double             inverse_radii  = 1.0 / equivalent_radius(bodies, law.templates, a);
    double             inverse_masses = inverse_mass(bodies, a);
    if (!wall)
    {
        inverse_radii += 1.0 / equivalent_radius(bodies, law.templates, b);
        inverse_masses += inverse_mass(bodies, b);
    }
    PairLaw found = pair_law(law.pairs(bodies.material[a], wall ? law.pairs.wall() : bodies.material[b]), law.options,
                             inverse_radii, inverse_masses);
    if (wall && law.planes[b - bodies.count].slip) { found.friction = 0; }
    return found;
}

} // namespace tread::dem
