#include "solver/bodies/named_means.hpp"

#include "backend/instantiate.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

template<class Exec>
NamedMeans<Exec>::NamedMeans(const Exec& exec, std::int64_t named)
    : impulses(exec, "contact impulses", named)
    , kept(static_cast<std::size_t>(named), Vec3<double>::Zero())
{
    impulses.fill_zero();
}

template<class Exec>
void NamedMeans<Exec>::transfer(StateFile& file)
{
    const std::size_t named = kept.size();
    transfer_impulses(file, "bodies/impulse", named, impulses);
    file.common("bodies/kept_impulse", kept, accept::all(accept::rows(named), accept::finite()));
}

template<class Exec>
void transfer_impulses(StateFile& file, const std::string& name, std::size_t named,
                       Array<Exec, dem::ContactImpulse>& impulses)
{
    std::vector<dem::ContactImpulse> rows         = impulses.to_host();
    const auto                       of_each_rank = [named, own = file.exact()](const auto& values)
    {
        const bool whole = own || named == 0 ? values.size() == named : values.size() % named == 0;
        return whole ? accept::Verdict{} : accept::rows(named)(values);
    };
    file.own_or_all(name, rows, accept::all(of_each_rank, accept::finite()));
    if (!file.loads()) { return; }
    std::vector<dem::ContactImpulse> sums(named, {Vec3<double>::Zero(), Vec3<double>::Zero()});
    const bool                       mine = file.exact() || file.communicator().rank() == 0;
    for (std::size_t i = 0; mine && i < rows.size(); ++i)
    {
        sums[i % named].linear += rows[i].linear;
        sums[i % named].angular += rows[i].angular;
    }
    impulses.assign(sums);
}

template<class Exec>
std::vector<dem::ContactImpulse> summed_impulses(const BodyState<Exec>& state, const NamedMeans<Exec>& means)
{
    std::vector<dem::ContactImpulse> sums = means.impulses.to_host();
    sum_over_ranks(state.communicator(), sums.data(), sums.size());
    return sums;
}

template<class Exec>
Vec3<double> contact_impulse(const BodyState<Exec>& state, const NamedMeans<Exec>& means, std::size_t body)
{
    return means.kept[body] + summed_impulses(state, means)[body].linear;
}

template<class Exec>
double carried(const BodyState<Exec>& state, const NamedMeans<Exec>& means, std::size_t body)
{
    const Vec3<double> impulse = contact_impulse(state, means, body);
    return -impulse.dot(state.gravity) / (state.world.bodies.mass[body] * state.gravity.squaredNorm());
}

template<class Exec>
void begin_mean(const BodyState<Exec>& state, NamedMeans<Exec>& means)
{
    const std::vector<dem::ContactImpulse> sums = summed_impulses(state, means);
    for (std::size_t b = 0; b < sums.size(); ++b) { means.kept[b] += sums[b].linear; }
    means.impulses.fill_zero();
    means.time = 0;
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template struct NamedMeans<Exec>;                                                                                  \
    template void transfer_impulses(StateFile&, const std::string&, std::size_t, Array<Exec, dem::ContactImpulse>&);   \
    template Vec3<double> contact_impulse(const BodyState<Exec>&, const NamedMeans<Exec>&, std::size_t);               \
    template void         begin_mean(const BodyState<Exec>&, NamedMeans<Exec>&);                                       \
    template std::vector<dem::ContactImpulse> summed_impulses(const BodyState<Exec>&, const NamedMeans<Exec>&);        \
    template double                           carried(const BodyState<Exec>&, const NamedMeans<Exec>&, std::size_t)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
