#pragma once

#include "kernels/dem/body_contact_impl.hpp"

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
    body_contact::EvaluatePair<MeetByDistance> evaluate;
    double                                     horizon;
    Vec3<double>                               fall; ///< m/s, what weight adds to a free body's mean velocity
    double*                                    entering;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const PairsView&          pairs = evaluate.pairs;
        body_contact::PairSetting setting;
        double                    found = 0;
        if (pairs.first_node[p] < pairs.first_node[p + 1])
        {
            evaluate.set_all(p, setting);
            let_fall(p, setting);
        }
        for (std::int32_t i = pairs.first_node[p]; i < pairs.first_node[p + 1]; ++i)
        {
            found += stiffness(setting, evaluate.look_up(p, setting, pairs.node[i]));
        }
        entering[p] = found;
    }

    TREAD_HD void let_fall(std::int64_t p, body_contact::PairSetting& setting) const
    {
        const BodiesView&  bodies = evaluate.bodies;
        const std::int64_t a = first_of(evaluate.pairs.key[p]), b = second_of(evaluate.pairs.key[p]);
        if (bodies.locked[a] != lock_all) { setting.motion.velocity += fall; }
        if (b < bodies.count && bodies.locked[b] != lock_all) { setting.motion.velocity -= fall; }
    }

    /// Of one node; 0 unless it comes inside.
    TREAD_HD double stiffness(const body_contact::PairSetting& setting, const NodeInField& node) const
    {
        if (node.overlap > 0) { return 0; }
        const double way = -horizon * node.sign * node.gradient.dot(setting.motion.at(node.place));
        return node.overlap + way > 0 ? node.weight * setting.law.linear_slope : 0.0;
    }
};

} // namespace tread::dem
