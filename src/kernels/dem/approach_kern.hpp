#pragma once

#include "kernels/dem/pair_law_kern.hpp"
#include "kernels/dem/sphere_contact_kern.hpp"

// The stiffness that a pair is about to gain: a flat face meets a wall with all its nodes in one substep, which the
// stiffness of the last one cannot tell.
namespace tread::dem
{

/// Sum of w p'(0) (N/m), the steepest, over a pair's listed nodes that are outside the other side and will be inside
/// within `horizon` (s) if their motion goes on and nothing holds them against gravity but a lock, by the distance
/// fields (rays tell nothing outside); 0 for exact spheres, whose first touch is known. However slow: a step too long
/// for the stiffness multiplies what little energy there is.
struct AnticipatePair
{
    BodiesView   bodies;
    BodyLaw      law;
    PairsView    pairs;
    double       horizon;
    Vec3<double> fall; ///< m/s, what weight adds to a free body's mean velocity
    double*      entering;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const NodeRun      nodes{pairs.node, pairs.first_node[p], pairs.first_node[p + 1]};
        double             found = 0;
        if (nodes.first < nodes.end)
        {
            found = b < bodies.count ? between_bodies(a, b, nodes, lanes)
                                     : against_plane(a, b - bodies.count, nodes, lanes);
        }
        if (lanes.lane() == 0) { entering[p] = found; }
    }

private:
    TREAD_HD Vec3<double> mean_velocity(std::int64_t b) const
    {
        return bodies.locked[b] == lock_all ? bodies.velocity[b] : Vec3<double>(bodies.velocity[b] + fall);
    }

    template<class Lanes>
    TREAD_HD double between_bodies(std::int64_t a, std::int64_t b, const NodeRun& nodes, const Lanes& lanes) const
    {
        const Couple         couple{{instance_of(bodies, law.templates, a, bodies.position[a]),
                                     instance_of(bodies, law.templates, b, bodies.position[a])}};
        const Vec3<double>&  spin = bodies.angular_velocity[b];
        const RelativeMotion motion{mean_velocity(a) - mean_velocity(b) + spin.cross(couple.body[1].centre),
                                    bodies.angular_velocity[a] - spin};
        return over_nodes(law_of(bodies, law, pair_key(a, b)), TwoSides<MeetByDistance>{{}, couple}, nodes, motion,
                          lanes);
    }

    template<class Lanes>
    TREAD_HD double against_plane(std::int64_t a, std::int64_t p, const NodeRun& nodes, const Lanes& lanes) const
    {
        const Plane&         plane = law.planes[p];
        const Instance       of_a  = instance_of(bodies, law.templates, a, bodies.position[a]);
        const RelativeMotion motion{mean_velocity(a), bodies.angular_velocity[a]};
        return over_nodes(law_of(bodies, law, pair_key(a, bodies.count + p)),
                          OneSide{{of_a, field_of(plane, bodies.position[a]), 1.0, 1.0}}, nodes, motion, lanes);
    }

    template<class Sides, class Lanes>
    TREAD_HD double over_nodes(const PairLaw& pair, const Sides& sides, const NodeRun& run,
                               const RelativeMotion& motion, const Lanes& lanes) const
    {
        const double first_slope = traction_at(pair, 0.0).slope; // no deeper one is steeper
        double       found       = 0;
        for (std::int32_t i = run.first + lanes.lane(); i < run.end; i += lanes.lanes())
        {
            const NodeInField node = sides(run.node[i]);
            if (node.overlap > 0) { continue; }
            const double way = -horizon * node.sign * node.gradient.dot(motion.at(node.place));
            if (node.overlap + way > 0) { found += Sides::stiffening(node) * node.weight * first_slope; }
        }
        return lanes.sum(found);
    }
};

} // namespace tread::dem
