#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "solver/rigid.hpp"
#include "solver/state_file.hpp"

// The bodies into a checkpoint, and out of it.
namespace tread::solver
{
namespace
{

/// What was asked of a named body last, as doubles.
struct CommandRow
{
    double given, locked, has_spin, spin, has_forward, forward, has_lowering, lowering[3], weight;
};

CommandRow row_of(const std::optional<BodyCommand>& command)
{
    if (!command) { return {}; }
    const auto lowering = command->lowering.value_or(std::array<double, 3>{});
    return {1.0,
            static_cast<double>(command->locked),
            command->spin ? 1.0 : 0.0,
            command->spin.value_or(0),
            command->forward ? 1.0 : 0.0,
            command->forward.value_or(0),
            command->lowering ? 1.0 : 0.0,
            {lowering[0], lowering[1], lowering[2]},
            command->weight};
}

std::optional<BodyCommand> command_of(const CommandRow& row)
{
    if (row.given == 0) { return {}; }
    BodyCommand command{static_cast<std::uint32_t>(row.locked), {}, {}};
    command.weight = row.weight;
    if (row.has_spin != 0) { command.spin = row.spin; }
    if (row.has_forward != 0) { command.forward = row.forward; }
    if (row.has_lowering != 0) { command.lowering = {row.lowering[0], row.lowering[1], row.lowering[2]}; }
    return command;
}

} // namespace

template<class Exec>
void Rigid<Exec>::transfer(StateFile& file)
{
    if (!file.loads() && ranks_) { ranks_->collect(bodies_); }
    bodies_.for_each_field([&](const char* name, auto& array) { file.common(fmt::format("bodies/{}", name), array); });
    file.numbers("bodies/steps", deals_, watched_, commanded_speed_, overlap_, mean_time_, substep_, command_work_);
    file.doubles("bodies/command_impulse", command_impulse_);
    transfer_commands(file);
    transfer_means(file);
    transfer_contacts(file);
    if (file.exact()) { transfer_lists(file); }
    else if (file.loads())
    {
        totals_.fill_zero(); // what they grew by was booked when the state was saved
        taken_  = read(exec_, totals_.data());
        listed_ = false;
    }
}

template<class Exec>
void Rigid<Exec>::transfer_commands(StateFile& file)
{
    std::vector<CommandRow>   commands;
    std::vector<std::int32_t> released(released_.begin(), released_.end());
    for (const auto& command : commanded_) { commands.push_back(row_of(command)); }
    file.common("bodies/commanded", commands);
    file.common("bodies/released", released);
    if (!file.loads()) { return; }
    std::transform(commands.begin(), commands.end(), commanded_.begin(), command_of);
    std::transform(released.begin(), released.end(), released_.begin(), [](std::int32_t value) { return value != 0; });
}

/// Ranks add up what each of them has seen.
template<class Exec>
void Rigid<Exec>::transfer_means(StateFile& file)
{
    std::vector<dem::ContactImpulse> impulses = impulses_.to_host();
    file.own_or_all("bodies/impulse", impulses);
    file.common("bodies/kept_impulse", kept_impulses_);
    if (!file.loads()) { return; }
    const auto                       named = static_cast<std::size_t>(named_);
    std::vector<dem::ContactImpulse> sums(named, {Vec3<double>::Zero(), Vec3<double>::Zero()});
    const bool                       mine = file.exact() || file.communicator().rank() == 0;
    for (std::size_t i = 0; mine && i < impulses.size(); ++i)
    {
        sums[i % named].linear += impulses[i].linear;
        sums[i % named].angular += impulses[i].angular;
    }
    impulses_.assign(sums);
}

/// What the listed pairs remember: as the last list of one rank, or of the pairs that this rank is to answer.
template<class Exec>
void Rigid<Exec>::transfer_contacts(StateFile& file)
{
    std::vector<std::uint64_t> keys    = pairs_.key.to_host();
    std::vector<dem::Patch>    patches = pairs_.patch.to_host();
    std::vector<dem::Rolling>  rolling = pairs_.rolling.to_host();
    std::vector<Vec3<double>>  places  = pairs_.patches.place.to_host();
    const bool                 several = file.communicator().maximum(places.empty() ? 0 : 1) > 0;
    rolling.resize(keys.size(), dem::no_rolling());
    places.resize(keys.size(), Vec3<double>::Zero());
    bool with_places = several;
    file.numbers("pairs/several", with_places);
    file.own_or_all("pairs/key", keys);
    file.own_or_all("pairs/patch", patches);
    file.own_or_all("pairs/rolling", rolling);
    file.own_or_all("pairs/place", places);
    if (!file.loads()) { return; }

    std::vector<std::size_t> order;
    const auto               is_large = pairs_.is_large.to_host();
    for (std::size_t p = 0; p < keys.size(); ++p)
    {
        if (file.exact() || !ranks_ || ranks_->owns(ranks_->decider(is_large, keys[p]))) { order.push_back(p); }
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    const auto chosen = [&](const auto& all)
    {
        std::decay_t<decltype(all)> some;
        for (const std::size_t p : order) { some.push_back(all[p]); }
        return some;
    };
    pairs_.key.assign(chosen(keys));
    pairs_.patch.assign(chosen(patches));
    if (pairs_.resists_rolling) { pairs_.rolling.assign(chosen(rolling)); }
    pairs_.patches.place.resize(0);
    if (with_places) { pairs_.patches.place.assign(chosen(places)); }
}

template<class Exec>
void Rigid<Exec>::transfer_lists(StateFile& file)
{
    std::vector<double> peaks = pairs_.peak.to_host();
    file.own("pairs/peak", peaks);
    file.own("pairs/travel", pairs_.travel);
    file.own("pairs/first_node", pairs_.first_node);
    file.own("pairs/node", pairs_.node);
    file.own("pairs/several_first", pairs_.patches.several);
    file.own("bodies/position_at_search", strays_.position);
    file.own("bodies/orientation_at_search", strays_.orientation);
    file.own("bodies/totals", totals_);
    file.doubles("bodies/taken", taken_);
    file.numbers("pairs/listed", listed_);
    if (!file.loads() || !listed_) { return; }
    dem::resume_list(exec_, pairs_, bodies_.view());
    pairs_.peak.assign(peaks);
}

template void Rigid<Cpu>::transfer(StateFile&);
#ifdef TREAD_WITH_CUDA
template void Rigid<Gpu>::transfer(StateFile&);
#endif

} // namespace tread::solver
