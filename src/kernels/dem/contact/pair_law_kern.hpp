#pragma once

#include "kernels/dem/pairs/pairs.hpp"

namespace tread::dem
{

TREAD_HD double equivalent_radius(const BodiesView& bodies, const TemplateView* templates, std::int64_t b)
{
    return templates[bodies.shape[b]].equivalent_radius * bodies.scale[b];
}

/// Data of one side of a pair for the contact law.
struct LawSide
{
    double       inverse_radius; ///< 1/m
    double       inverse_mass;   ///< 1/kg
    std::int32_t material;
};

TREAD_HD LawSide side_of(const ContactBody& body, const TemplateView* templates)
{
    return {1.0 / (templates[body.shape].equivalent_radius * body.scale), body.inverse_mass, body.material};
}

TREAD_HD LawSide wall_side(const BodyLaw& law) { return {0, 0, law.pairs.wall()}; }

TREAD_HD PairLaw law_between(const BodyLaw& law, const LawSide& a, const LawSide& b)
{
    return pair_law(law.pairs(a.material, b.material), law.options, a.inverse_radius + b.inverse_radius,
                    a.inverse_mass + b.inverse_mass);
}

/// Makes the law of a body and a wall: R* is the body's own radius, and a slip wall has no friction.
TREAD_HD PairLaw law_against(const BodyLaw& law, const LawSide& a, const Plane& wall)
{
    PairLaw found = law_between(law, a, wall_side(law));
    if (wall.slip) { found.friction = 0; }
    return found;
}

/// Makes the law of a listed pair; `bodies` = number of bodies.
TREAD_HD PairLaw law_of(const PairsView& pairs, const BodyLaw& law, std::int64_t bodies, std::uint64_t key)
{
    const std::int64_t b     = second_of(key);
    const LawSide      first = side_of(pairs.body[first_of(key)], law.templates);
    return b < bodies ? law_between(law, first, side_of(pairs.body[b], law.templates))
                      : law_against(law, first, law.planes[b - bodies]);
}

} // namespace tread::dem
