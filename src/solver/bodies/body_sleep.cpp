#include "solver/bodies/body_sleep.hpp"

#include <memory>

#include "backend/instantiate.hpp"
#include "decomp/combine.hpp"
#include "solver/bodies/row_transfer.hpp"
#include "solver/bodies/sleeping_records.hpp"
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
    return static_cast<double>(static_cast<std::int64_t>(state.numbers().bodies()) - state.named());
}

/// Holders of a body exchange what they know of it.
template<class Exec>
class SharedSleep : public dem::RanksOfSleepers<Exec>
{
public:
    explicit SharedSleep(BodyRanks<Exec>& ranks)
        : ranks_(ranks)
    {
        ranks.begin_sleep();
    }

    dem::SharedView shared() override { return ranks_.shared().view(); }
    void            exchange_marks() override { ranks_.shared().exchange_marks(); }
    void            exchange_wrenches() override { ranks_.shared().exchange_wrenches(); }
    void add(double* values, int count) const override { decomp::combine(ranks_.communicator(), values, count, 0); }

private:
    BodyRanks<Exec>& ranks_;
};

void transfer_clock(StateFile& file, dem::SleepClock& clock, SleepSettings& settings, std::size_t phases)
{
    const auto time = [](double& value) { return accept::number(value, 0, accept::largest); };
    file.numbers("rock_sleep/times", time(clock.look), time(clock.window), time(clock.held), time(clock.weight),
                 time(clock.slept), time(clock.lived),
                 accept::number(settings.phase, -1, static_cast<double>(phases) - 1));
}

} // namespace

template<class Exec>
void begin_sleep(BodyState<Exec>& state)
{
    const scene::Sleep&        sleep = state.scene.sleep;
    dem::SleepingBodies<Exec>& all   = state.pairs.sleep;
    all.strewn                       = sleep.distance && state.world.sand.size() > 0;
    dem::begin_sleep(state.exec, state.pairs, state.bodies,
                     {sleep.rock_speed.value(), sleep.rock_rest, sleep.rock_load, state.named()});
    if (state.ranks) { all.ranks = std::make_unique<SharedSleep<Exec>>(*state.ranks); }
    if (!all.strewn) { return; }
    const auto rows = static_cast<std::size_t>(state.bodies.position.size());
    all.bed.assign(std::vector<std::int32_t>(rows, dem::bed_awake));
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
    dem::SleepingBodies<Exec>& sleep = state.pairs.sleep;
    transfer_clock(file, sleep.clock, settings, state.scene.phases.size());
    RowTransfer<Exec> transfer{file, state.numbers(), file.loads() ? BodyBlocks() : state.blocks()};
    transfer("rock_sleep/asleep", state.bodies.asleep, accept::within(0, 1));
    transfer("rock_sleep/position", sleep.position, accept::finite());
    transfer("rock_sleep/orientation", sleep.orientation, accept::unit_quaternions());
    transfer("rock_sleep/quiet", sleep.quiet, accept::not_negative());
    transfer("rock_sleep/moves", sleep.moves, accept::within(0, 1));
    if (sleep.strewn) { transfer("rock_sleep/bed", sleep.bed, accept::within(dem::bed_none, dem::bed_asleep)); }
    transfer("rock_sleep/load", sleep.watch, accept::finite());
    transfer_sleeping_pairs(state, file);
    if (!file.loads()) { return; }
    if (!file.exact())
    {
        dem::wake_all(state.pairs, state.bodies);
        sleep.bed.assign(std::vector<std::int32_t>(static_cast<std::size_t>(sleep.bed.size()), dem::bed_awake));
    }
    sleep.mark.resize(state.bodies.position.size());
    sleep.mark.fill_zero();
    sleep.resize_sand(state.bodies.position.size());
    dem::resume_sleep(state.exec, state.pairs, state.view());
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
