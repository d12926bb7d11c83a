#include "solver/bodies/pair_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "kernels/dem/pairs/displacement_kern.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"
#include "solver/ranks/over_ranks.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

constexpr double hit_twice = 4; ///< speed of a light body hit by one that was itself hit, over the largest now

/// A body that a surface at speed v begins to push with stiffness K moves v (t - sin(w t) / w) in a time t,
/// w = sqrt(K / m); off its centre a ball yields 7/2 times as easily. Up to t = sqrt(m / K) that is less than
/// hit_soon v t.
constexpr double hit_soon = 0.5;

/// Share of a step over which displacements are extrapolated at its start, if the list is also checked within the
/// step.
constexpr double watched_share = 0.5;

/// Address of the maximum in the backend's memory.
template<class Exec>
const double* displacement_ahead(BodyState<Exec>& state, PairLists<Exec>& lists, const dem::Ahead& ahead)
{
    return dem::largest_displacement_ahead(state.exec, lists.displacements, state.view(), state.tables.law.templates,
                                           state.pairs.displacement.view(), lists.age, ahead);
}

/// Changes nothing before the list is known to be valid on all ranks.
template<class Exec>
bool is_valid(BodyState<Exec>& state, PairLists<Exec>& lists, double dt)
{
    const Communicator* ranks = state.communicator();
    const bool          known = lists.listed && !(state.ranks && state.ranks->pages_have_changed());
    const double        ahead = lists.checked_within_step ? watched_share * dt : dt;
    if (!known || largest_over_ranks(ranks, read(state.exec, displacement_ahead(state, lists, {ahead, dt}))) > 1)
    {
        return false;
    }
    if (!state.pairs.patches.wanted) { return true; }
    const bool suffices = dem::patch_rows_suffice(state.exec, state.pairs, state.view(), state.tables.law);
    if (largest_over_ranks(ranks, suffices ? 0 : 1) > 0) { return false; }
    dem::regroup_patches(state.exec, state.pairs, state.view(), state.tables.law);
    return true;
}

/// What sleeps is weighed anew on all ranks or on none.
template<class Exec>
void agree_on_sleepers(BodyState<Exec>& state)
{
    dem::SleepingBodies<Exec>& sleep = state.pairs.sleep;
    if (sleep.wanted) { sleep.change = largest_over_ranks(state.communicator(), sleep.change ? 1 : 0) > 0; }
}

template<class Exec>
void build(BodyState<Exec>& state, PairLists<Exec>& lists, double dt, double substeps, UnheldRows unheld)
{
    const Exec&         exec  = state.exec;
    dem::Pairs<Exec>&   pairs = state.pairs;
    const dem::BodyLaw& law   = state.tables.law;
    dem::begin_list(exec, pairs, state.view(), law);
    if (state.shares())
    {
        dem::share_speeds(exec, pairs, state.view(), law, state.shared());
        state.ranks->shared().exchange_speeds();
    }
    dem::request_displacement(exec, pairs, state.view(), law, dt, state.gravity.norm(), state.shared());
    if (state.ranks) { state.ranks->sum_wanted_displacement(pairs); }
    dem::allow_displacement(exec, pairs, state.view(), law, dt, substeps,
                            static_cast<std::int64_t>(state.numbers().bodies()));
    if (state.ranks)
    {
        state.assign_owners(unheld);
        agree_on_sleepers(state);
    }
    dem::list_pairs(exec, pairs, state.view(), law);
    dem::mark_places(exec, lists.displacements, state.view());
    lists.listed = true;
    lists.age    = 0;
    ++lists.version;
}

/// Accepts, for each pair, nodes of its bodies: i of the first, ~i of the second. `shape`: of each row's body. `first`:
/// start of each pair's nodes.
auto accepted_nodes(const world::World& world, const std::vector<std::int32_t>& shape,
                    const std::vector<std::uint64_t>& keys, const std::vector<std::int32_t>& first)
{
    return [&](const std::vector<std::int32_t>& values) -> accept::Verdict
    {
        const auto nodes_of = [&](std::int64_t row)
        {
            const auto form = static_cast<std::size_t>(shape[static_cast<std::size_t>(row)]);
            return static_cast<std::int64_t>(world.templates[form].nodes.positions.size());
        };
        for (std::size_t pair = 0; pair + 1 < first.size(); ++pair)
        {
            const std::int64_t a = dem::first_of(keys[pair]), b = dem::second_of(keys[pair]);
            const bool         wall = b >= static_cast<std::int64_t>(shape.size());
            const std::int64_t high = nodes_of(a) - 1, low = wall ? 0 : -nodes_of(b);
            for (auto i = static_cast<std::size_t>(first[pair]); i < static_cast<std::size_t>(first[pair + 1]); ++i)
            {
                if (low <= values[i] && values[i] <= high) { continue; }
                return accept::Refusal{static_cast<std::int64_t>(i), fmt::format("{}", values[i]),
                                       fmt::format("{} to {}", low, high)};
            }
        }
        return {};
    };
}

} // namespace

template<class Exec>
bool update_pairs(BodyState<Exec>& state, PairLists<Exec>& lists, double dt, double substeps, UnheldRows unheld)
{
    const bool valid = is_valid(state, lists, dt);
    if (!valid) { build(state, lists, dt, substeps, unheld); }
    dem::expect_contacts(state.exec, state.pairs, state.view(), state.tables.law, state.gravity, dt, state.shared());
    if (state.ranks)
    {
        state.ranks->shared().exchange_stiffness();
        dem::expect_shared_contacts(state.exec, state.pairs, state.shared());
    }
    return !valid;
}

template<class Exec>
void begin_substeps(const BodyState<Exec>& state, PairLists<Exec>& lists, const TimeStep& step,
                    const MotionBound& motion, double contact_time)
{
    lists.begin(step);
    const auto   number = static_cast<double>(step.substeps);
    const double dt = step.dt / number, reserve = dem::rest_reserve * state.tables.smallest_radius,
                 fall         = motion.acceleration * step.dt;
    const double unseen       = reserve / (dt * (hit_twice * motion.speed + fall)); // in substeps
    lists.checked_within_step = number > unseen;
    if (!lists.checked_within_step) { return; }
    const double soon  = std::min(contact_time / dt, reserve / (dt * (hit_soon * motion.speed + fall)));
    const double batch = std::max(unseen, soon) / static_cast<double>(dem::batches_ahead);
    lists.batch        = static_cast<std::int64_t>(std::clamp(batch, 1.0, number));
}

template<class Exec>
void agree_on_list(BodyState<Exec>& state, PairLists<Exec>& lists)
{
    state.ranks->largest(lists.substeps.data());
}

double unchecked_span(double smallest_radius, const MotionBound& motion)
{
    // Displacement bound in a time t by speed and gravity: t (4 v + g t) <= reserve.
    const double fall = motion.acceleration, reserve = dem::rest_reserve * smallest_radius,
                 start = hit_twice * motion.speed;
    return 2 * reserve / (start + std::sqrt(start * start + 4 * fall * reserve));
}

template<class Exec>
std::int64_t steps_without_check(const BodyState<Exec>& state, double dt, const MotionBound& motion)
{
    if (!state.has_contact) { return std::numeric_limits<std::int64_t>::max(); }
    const double span = unchecked_span(state.tables.smallest_radius, motion);
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(span / dt, 1e9)));
}

template<class Exec>
void PairLists<Exec>::begin(const TimeStep& next)
{
    expired    = false;
    of_step    = next.substeps;
    substep_dt = next.dt / static_cast<double>(next.substeps);
    done = requested = 0;
    if (std::exchange(last, 0) != 0) { substeps.fill_zero(); }
}

template<class Exec>
dem::DisplacementLimit PairLists<Exec>::limit(BodyState<Exec>& state)
{
    if (!checked_within_step) { return {}; }
    const double before = age - substep_dt * static_cast<double>(done);
    return {displacements.listed(state.pairs.displacement.view(), before),
            state.tables.law.templates,
            substep_dt,
            static_cast<std::int32_t>(batch),
            static_cast<std::int32_t>(of_step),
            substeps.data(),
            static_cast<std::int32_t>(requested + 1),
            substeps.data() + 1};
}

template<class Exec>
std::int64_t PairLists<Exec>::take_done(const Exec& exec)
{
    const std::int64_t before = std::exchange(done, requested);
    if (checked_within_step) { last = read(exec, substeps.data()); }
    if (last != 0 && last <= requested)
    {
        expired = last < of_step;
        done = requested = std::exchange(last, 0);
        substeps.fill_zero();
    }
    age += substep_dt * static_cast<double>(done - before);
    return done - before;
}

template<class Exec>
void PairLists<Exec>::transfer(StateFile& file, BodyState<Exec>& state)
{
    if (!file.exact())
    {
        if (file.loads()) { listed = false; }
        return;
    }
    dem::Pairs<Exec>& pairs = state.pairs;
    const auto        count = static_cast<std::size_t>(state.bodies.position.size());
    file.numbers("pairs/listed", listed, accept::number(age, 0, accept::largest));
    const std::vector<std::uint64_t> keys = pairs.key.to_host();
    // Without a list there are no rows.
    const auto of_each = [&](std::size_t rows, auto bound)
    {
        return [&, rows, bound](const auto& values)
        { return !listed && values.empty() ? accept::Verdict{} : accept::all(accept::rows(rows), bound)(values); };
    };
    std::vector<double>       peaks = pairs.peak.to_host();
    std::vector<std::int32_t> first = pairs.nodes.first.to_host();
    const auto                shape = state.bodies.shape.to_host();
    file.own("pairs/peak", peaks, of_each(keys.size(), accept::finite()));
    file.own("pairs/travel", pairs.displacement.allowed, of_each(count, accept::not_negative()));
    file.own("pairs/drift", pairs.displacement.drift, of_each(count, accept::finite()));
    file.own("pairs/drift_time", pairs.displacement.span, accept::all(accept::rows(1), accept::not_negative()));
    file.own("pairs/first_node", first, of_each(keys.size() + 1, accept::cuts()));
    const std::size_t nodes = first.empty() ? 0 : static_cast<std::size_t>(std::max(first.back(), 0));
    file.own("pairs/node", pairs.nodes.node,
             accept::all(accept::rows(nodes), accepted_nodes(state.world, shape, keys, first)));
    file.own("pairs/several_first", pairs.patches.several,
             accept::all(accept::ascending(), accept::index(keys.size())));
    file.own("bodies/position_at_search", displacements.position, of_each(count, accept::finite()));
    file.own("bodies/orientation_at_search", displacements.orientation, of_each(count, accept::unit_quaternions()));
    if (!file.loads() || !listed) { return; }
    pairs.nodes.first.assign(first);
    pairs.displacement.drifting = true; // as far as is known
    dem::resume_list(state.exec, pairs, state.view());
    pairs.peak.assign(peaks);
}

#define TREAD_INSTANTIATE(Exec)                                                                                         \
    template struct PairLists<Exec>;                                                                                    \
    template bool         update_pairs(BodyState<Exec>&, PairLists<Exec>&, double, double, UnheldRows);                 \
    template void         begin_substeps(const BodyState<Exec>&, PairLists<Exec>&, const TimeStep&, const MotionBound&, \
                                         double);                                                                       \
    template void         agree_on_list(BodyState<Exec>&, PairLists<Exec>&);                                            \
    template std::int64_t steps_without_check(const BodyState<Exec>&, double, const MotionBound&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
