#pragma once

#include "kernels/dem/contact/body_contact_impl.hpp"

// Anticipated stiffness of a pair: when a flat face meets a wall, all its nodes come into contact in one substep, which
// the stiffness of the last substep does not show.
namespace tread::dem
{

/// Computes the sum of w p'(0) (N/m), the maximum slope, over a pair's listed nodes that are outside the other body and
/// will be inside within `horizon` (s) if their motion continues and only locks hold them against gravity. Uses the
/// distance fields (rays give no distance outside); 0 for exact spheres, whose first touch is known. Slow nodes count
/// as well: a time step too long for the stiffness amplifies even a small energy.
struct AnticipatePair
{
    BodiesView   bodies;
    BodyLaw      law;
    PairsView    pairs; ///< with found_node up to date
    double       horizon;
    Vec3<double> fall; ///< m/s, change of a free body's mean velocity by its weight
    double*      entering;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const std::int32_t first = pairs.first_node[p], last = pairs.first_node[p + 1];
        double             found = 0;
        if (first < last)
        {
            const body_contact::PairSetting setting = body_contact::setting_of(pairs, law, bodies.count, pairs.key[p]);
            const RelativeMotion            motion{setting.motion.velocity + falling(p), setting.motion.spin};
            for (std::int32_t i = first + lanes.lane(); i < last; i += lanes.lanes())
            {
                found += entering_weight(motion, unpacked(pairs.found_node[i]));
            }
            found = setting.law.linear_slope * lanes.sum(found);
        }
        if (lanes.lane() == 0) { entering[p] = found; }
    }

private:
    /// Returns the weight's contribution to the velocity of the first body relative to the second, m/s.
    TREAD_HD Vec3<double> falling(std::int64_t p) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        double             sides = 0;
        if (!bodies.is_fixed(a)) { sides += 1; }
        if (b < bodies.count && !bodies.is_fixed(b)) { sides -= 1; }
        return sides * fall;
    }

    /// Returns the contribution of a node that will enter; 0 for any other node.
    TREAD_HD double entering_weight(const RelativeMotion& motion, const NodeInField& node) const
    {
        if (node.overlap > 0) { return 0; }
        const double way = -horizon * node.sign * node.gradient.dot(motion.at(node.place));
        return node.overlap + way > 0 ? node.weight : 0.0;
    }
};

} // namespace tread::dem
