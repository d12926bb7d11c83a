#include "solver/bodies/body_sleep.hpp"

#include "backend/instantiate.hpp"
#include "solver/bodies/contact_records.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Share of the awake rocks: fewer do not fall asleep by themselves, since a new list costs as much as many substeps.
constexpr double worth_a_list = 1.0 / 16;

template<class Exec>
double rocks_of(const BodyState<Exec>& state)
{
    return static_cast<double>(state.bodies.position.size() - state.named());
}

void transfer_clock(StateFile& file, dem::SleepClock& clock, SleepSettings& settings, std::size_t phases)
{
    const auto time = [](double& value) { return accept::number(value, 0, accept::largest); };
    file.numbers("rock_sleep/times", time(clock.look), time(clock.window), time(clock.held), time(clock.weight),
                 time(clock.slept), time(clock.lived),
                 accept::number(settings.phase, -1, static_cast<double>(phases) - 1));
}

template<class Exec, class T, class Bound>
void transfer_array(StateFile& file, const char* name, Array<Exec, T>& array, const Bound& accepted)
{
    std::vector<T> values = array.to_host();
    file.own_or_all(name, values, accepted);
    if (file.loads()) { array.assign(values); }
}

} // namespace

template<class Exec>
void begin_sleep(BodyState<Exec>& state)
{
    const scene::Sleep& sleep = state.scene.sleep;
    dem::begin_sleep(state.exec, state.pairs, state.bodies,
                     {sleep.rock_speed.value(), sleep.rock_rest, sleep.rock_load, state.named()});
    if (!sleep.distance || state.world.sand.size() == 0) { return; }
    dem::SleepingBodies<Exec>& all   = state.pairs.sleep;
    const std::int64_t         count = state.bodies.position.size();
    all.sand.resize(count);
    all.sand.fill_zero();
    all.next_bed.resize(count);
    all.bed.assign(std::vector<std::int32_t>(static_cast<std::size_t>(count), dem::bed_awake));
}

template<class Exec>
void follow_beds(BodyState<Exec>& state, PairLists<Exec>& lists, BodyReports<Exec>& reports, double substep)
{
    const dem::SleepCount found = dem::follow_beds(state.exec, state.pairs, state.view());
    if (found.tired > 0)
    {
        dem::fall_asleep(state.exec, state.pairs, state.view(), state.tables.law, reports.totals.data(), substep,
                         state.gravity);
    }
    if (found.tired > 0 || found.wake > 0) { lists.listed = false; }
}

template<class Exec>
void update_sleep(BodyState<Exec>& state, PairLists<Exec>& lists, BodyReports<Exec>& reports,
                  const SleepSettings& settings, double substep)
{
    dem::SleepingBodies<Exec>& sleep = state.pairs.sleep;
    if (!sleep.wanted || !lists.listed) { return; }
    if (settings.damping > 0)
    {
        sleep.clock.look = 0;
        return;
    }
    const dem::SleepCount found = dem::look_at_sleep(state.exec, state.pairs, state.view(), state.tables.law);
    const bool            sorts = found.wake > 0;
    const bool            tires = found.tired > 0 && (sorts || found.tired >= worth_a_list * found.awake);
    if (tires)
    {
        dem::fall_asleep(state.exec, state.pairs, state.view(), state.tables.law, reports.totals.data(), substep,
                         state.gravity);
    }
    if (sorts || tires) { lists.listed = false; }
}

template<class Exec>
void wake_for_phase(BodyState<Exec>& state, PairLists<Exec>& lists, SleepSettings& settings, std::size_t phase)
{
    if (!state.pairs.sleep.wanted || settings.phase == static_cast<std::int64_t>(phase)) { return; }
    settings.phase = static_cast<std::int64_t>(phase);
    dem::wake_all(state.pairs, state.bodies);
    if (state.pairs.sleep.count > 0) { lists.listed = false; }
}

template<class Exec>
std::optional<double> mean_asleep(const BodyState<Exec>& state)
{
    if (!state.pairs.sleep.wanted) { return std::nullopt; }
    const dem::SleepClock& clock = state.pairs.sleep.clock;
    return clock.lived > 0 ? clock.slept / (clock.lived * rocks_of(state)) : 0.0;
}

template<class Exec>
void transfer_sleep(BodyState<Exec>& state, SleepSettings& settings, StateFile& file)
{
    dem::SleepingBodies<Exec>& sleep  = state.pairs.sleep;
    dem::SleepingPairs<Exec>&  pairs  = sleep.pairs;
    const auto                 bodies = static_cast<std::size_t>(state.bodies.position.size());
    transfer_clock(file, sleep.clock, settings, state.scene.phases.size());
    transfer_array(file, "rock_sleep/asleep", state.bodies.asleep,
                   accept::all(accept::rows(bodies), accept::within(0, 1)));
    transfer_array(file, "rock_sleep/position", sleep.position, accept::all(accept::rows(bodies), accept::finite()));
    transfer_array(file, "rock_sleep/orientation", sleep.orientation,
                   accept::all(accept::rows(bodies), accept::unit_quaternions()));
    transfer_array(file, "rock_sleep/quiet", sleep.quiet, accept::all(accept::rows(bodies), accept::not_negative()));
    transfer_array(file, "rock_sleep/moves", sleep.moves, accept::all(accept::rows(bodies), accept::within(0, 1)));
    if (sleep.bed.size() > 0)
    {
        transfer_array(file, "rock_sleep/bed", sleep.bed,
                       accept::all(accept::rows(bodies), accept::within(dem::bed_none, dem::bed_asleep)));
    }
    transfer_array(file, "rock_sleep/load", sleep.watch, accept::all(accept::rows(bodies), accept::finite()));
    transfer_array(file, "rock_sleep/key", pairs.key,
                   accept::all(accepted_keys(state.world), accept::ascending(), accept::distinct()));
    const auto of_each = accept::all(accept::rows(static_cast<std::size_t>(pairs.key.size())), accept::finite());
    transfer_array(file, "rock_sleep/patch", pairs.patch, of_each);
    transfer_array(file, "rock_sleep/place", pairs.place, of_each);
    transfer_array(file, "rock_sleep/contact", pairs.contact, of_each);
    if (state.pairs.resists_rolling) { transfer_array(file, "rock_sleep/rolling", pairs.rolling, of_each); }
    if (file.loads()) { dem::resume_sleep(state.exec, state.pairs, state.view()); }
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void begin_sleep(BodyState<Exec>&);                                                                       \
    template void follow_beds(BodyState<Exec>&, PairLists<Exec>&, BodyReports<Exec>&, double);                         \
    template void update_sleep(BodyState<Exec>&, PairLists<Exec>&, BodyReports<Exec>&, const SleepSettings&, double);  \
    template void wake_for_phase(BodyState<Exec>&, PairLists<Exec>&, SleepSettings&, std::size_t);                     \
    template std::optional<double> mean_asleep(const BodyState<Exec>&);                                                \
    template void                  transfer_sleep(BodyState<Exec>&, SleepSettings&, StateFile&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
