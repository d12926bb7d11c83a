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

TREAD_HD PairLaw law_between(const BodiesView& bodies, const BodyLaw& law, std::int64_t a, std::int64_t b)
{
    const double radius_a = equivalent_radius(bodies, law.templates, a);
    const double radius_b = equivalent_radius(bodies, law.templates, b);
    return pair_law(law.pairs(bodies.material[a], bodies.material[b]), law.options, 1.0 / radius_a + 1.0 / radius_b,
                    inverse_mass(bodies, a) + inverse_mass(bodies, b));
}

/// Against a wall: R* is the body's own radius, and a slip wall has no friction.
TREAD_HD PairLaw law_against(const BodiesView& bodies, const BodyLaw& law, std::int64_t a, const Plane& plane)
{
    PairLaw found = pair_law(law.pairs(bodies.material[a], law.pairs.wall()), law.options,
                             1.0 / equivalent_radius(bodies, law.templates, a), inverse_mass(bodies, a));
    if (plane.slip) { found.friction = 0; }
    return found;
}

} // namespace tread::dem
