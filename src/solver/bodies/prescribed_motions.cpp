#include "solver/bodies/prescribed_motions.hpp"

#include <algorithm>
#include <cmath>

#include "backend/instantiate.hpp"
#include "solver/bodies/named_means.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

constexpr double speed_rounding = 1e-9; ///< relative

/// m/s, speed of the surface of a body that the held axes prescribe. `radius`: m, of its bounding sphere.
double prescribed_speed(const dem::Prescribed& motion, double radius)
{
    Vec3<double> velocity = Vec3<double>::Zero(), spin = Vec3<double>::Zero();
    for (int c = 0; c < 3; ++c)
    {
        if ((motion.held >> c & 1u) != 0) { velocity[c] = motion.velocity[c]; }
        if ((motion.held >> (3 + c) & 1u) != 0) { spin[c] = motion.spin[c]; }
    }
    const double axle = (motion.held & dem::hold_axle) != 0 ? motion.axle_spin : 0;
    return velocity.norm() + radius * std::hypot(spin.norm(), axle);
}

} // namespace

template<class Exec>
PrescribedMotions<Exec>::PrescribedMotions(const Exec& exec, std::int64_t named)
    : exec_(exec)
    , present_(static_cast<std::size_t>(named), dem::no_motion())
    , motions_(exec, "prescribed motions")
    , reactions_(exec, "reaction impulses", named)
{
    motions_.assign(present_);
    reactions_.fill_zero();
}

template<class Exec>
double PrescribedMotions<Exec>::set(const BodyState<Exec>& state, const std::vector<BodyCommand>& commands)
{
    double largest = 0;
    for (std::size_t b = 0; b < commands.size(); ++b)
    {
        const auto& wanted = commands[b].motion;
        if (!wanted) { continue; }
        const world::HostBodies& bodies = state.world.bodies;
        const auto&              form   = world::template_of(state.world, b);
        largest = std::max(largest, prescribed_speed(*wanted, bodies.scale[b] * form.bounding_radius));
        if (*wanted == present_[b]) { continue; }
        present_[b] = *wanted;
        copy_from_host(exec_, motions_.data() + b, &present_[b], sizeof(dem::Prescribed));
    }
    return largest * (1 - speed_rounding);
}

template<class Exec>
std::vector<dem::ContactImpulse> PrescribedMotions<Exec>::mean_reactions(const BodyState<Exec>& state,
                                                                         double                 time) const
{
    std::vector<dem::ContactImpulse> sums = reactions_.to_host();
    const double                     over = time > 0 ? 1 / time : 0;
    for (dem::ContactImpulse& sum : sums)
    {
        sum_over_ranks(state.communicator(), sum);
        sum.linear *= over;
        sum.angular *= over;
    }
    return sums;
}

template<class Exec>
void PrescribedMotions<Exec>::transfer(StateFile& file)
{
    transfer_impulses(file, "bodies/reaction_impulse", present_.size(), reactions_);
}

#define TREAD_INSTANTIATE(Exec) template class PrescribedMotions<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
