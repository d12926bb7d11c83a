#pragma once

#include "kernels/dem/pair_law_kern.hpp"
#include "kernels/dem/sphere_contact_kern.hpp"

// The stiffness that a pair is about to have: a flat face meets a wall with all its nodes in one substep, which the
// stiffness of the last one cannot tell.
namespace tread::dem
{

/// The field that nodes will be in after `horizon` if nothing stops those that come nearer.
template<class Field>
struct Approached
{
    Field          field;
    RelativeMotion motion;
    double         sign;    ///< of the side that the nodes are on
    double         horizon; ///< s
    double         travel;  ///< m, no node comes nearer by more

    TREAD_HD double distance_from_centre(const Vec3<double>& y) const { return field.distance_from_centre(y); }
    TREAD_HD double reach() const { return field.reach() + travel; }
    TREAD_HD double bound(double r) const { return field.bound(r + travel); }

    TREAD_HD SdfSample operator()(const Vec3<double>& y) const
    {
        const SdfSample now = field(y);
        return {now.distance + horizon * std::fmin(sign * now.gradient.dot(motion.at(y)), 0.0), now.gradient};
    }
};

/// Sum of w p' (N/m) over a pair's nodes that are inside the other side, or will be within `horizon` (s); 0 for a pair
/// that moves too little to change, and for exact spheres, whose first touch is known.
struct AnticipatePair
{
    BodiesView bodies;
    BodyLaw    law;
    PairsView  pairs;
    double     horizon;
    double*    stiffness;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const double       found = b < bodies.count ? between_bodies(a, b, lanes) : against_plane(a, b, lanes);
        if (lanes.lane() == 0) { stiffness[p] = found; }
    }

private:
    /// What the nodes of a pair at most move against the other side, m; 0 = nothing that its stiffness would feel.
    TREAD_HD double travel(const PairLaw& pair, const Instance& of_a, const RelativeMotion& motion) const
    {
        constexpr double unfelt   = 0.1; ///< of the overlap in which the traction is linear
        const double     furthest = of_a.scale * of_a.shape->bounding_radius;
        const double     moved    = horizon * (motion.velocity.norm() + motion.spin.norm() * furthest);
        return moved > unfelt * pair.linear_overlap ? moved : 0.0;
    }

    template<class Field, class Lanes>
    TREAD_HD static void add(const PairLaw& pair, const Instance& owner, const Approached<Field>& field, double share,
                             const Lanes& lanes, Stiffness& found)
    {
        find_live(pair, Side<Approached<Field>>{owner, field, share, field.sign}, lanes, found);
    }

    template<class Lanes>
    TREAD_HD double between_bodies(std::int64_t a, std::int64_t b, const Lanes& lanes) const
    {
        const PairLaw        pair = law_between(bodies, law, a, b);
        const Instance       of_a = instance_of(bodies, law.templates, a, bodies.position[a]);
        const Instance       of_b = instance_of(bodies, law.templates, b, bodies.position[a]);
        const Vec3<double>&  spin = bodies.angular_velocity[b];
        const RelativeMotion motion{bodies.velocity[a] - bodies.velocity[b] + spin.cross(of_b.centre),
                                    bodies.angular_velocity[a] - spin};
        const double         moved = travel(pair, of_a, motion);
        if (moved == 0 || (is_sphere(of_a) && is_sphere(of_b))) { return 0; }
        Stiffness found{0, 0};
        add(pair, of_a, Approached<BodyField>{{of_b}, motion, 1.0, horizon, moved}, 0.5, lanes, found);
        add(pair, of_b, Approached<BodyField>{{of_a}, motion, -1.0, horizon, moved}, 0.5, lanes, found);
        return lanes.sum(found.sum);
    }

    template<class Lanes>
    TREAD_HD double against_plane(std::int64_t a, std::int64_t b, const Lanes& lanes) const
    {
        const Plane&         plane = law.planes[b - bodies.count];
        const PairLaw        pair  = law_against(bodies, law, a, plane);
        const Instance       of_a  = instance_of(bodies, law.templates, a, bodies.position[a]);
        const PlaneField     wall{plane.normal, plane.offset - plane.normal.dot(bodies.position[a])};
        const RelativeMotion motion{bodies.velocity[a], bodies.angular_velocity[a]};
        const double         moved = travel(pair, of_a, motion);
        if (moved == 0 || is_sphere(of_a)) { return 0; }
        Stiffness found{0, 0};
        add(pair, of_a, Approached<PlaneField>{wall, motion, 1.0, horizon, moved}, 1.0, lanes, found);
        return lanes.sum(found.sum);
    }
};

} // namespace tread::dem
