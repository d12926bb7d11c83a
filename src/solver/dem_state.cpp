#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "solver/dem_solver.hpp"
#include "solver/state_file.hpp"

// Saves the bodies to a checkpoint, and loads them.
namespace tread::solver
{
namespace
{

constexpr double freedoms = dem::lock_all | dem::hangs; ///< all bits of BodiesView::locked
constexpr double furthest = 1e6;   ///< m, largest accepted distance of a body from the domain's corner
constexpr double fastest  = 1e6;   ///< m/s and rad/s: steps with faster bodies would not end
constexpr double shortest = 1e-10; ///< s, smallest accepted sqrt(m / K) of a body with contacts of stiffness K

/// Last command of a named body, as doubles.
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

/// Accepts contact stiffnesses of bodies that do not require endless substeps.
auto accepted_stiffness(const world::HostBodies& bodies)
{
    const auto most = [&bodies](std::size_t b) { return bodies.mass[b] / (shortest * shortest); };
    return accept::each_at([most](std::size_t b, double value) { return 0 <= value && value <= most(b); },
                           [most](std::size_t b) { return fmt::format("0 to {}", most(b)); });
}

/// Accepts valid values of a body field; `present`: the scene's values, as sizes, shapes and materials must not
/// change.
template<class T>
auto accepted_field(std::string_view name, std::vector<T> present, const world::HostBodies& bodies)
{
    return [name, &bodies, present = std::move(present)](const std::vector<T>& values) -> accept::Verdict
    {
        if (auto refusal = accept::rows(present.size())(values)) { return refusal; }
        if constexpr (std::is_same_v<T, std::uint32_t>) { return accept::within(0, freedoms)(values); }
        else if constexpr (std::is_same_v<T, std::int32_t>)
        {
            return name == "damped" ? accept::within(0, 1)(values) : accept::same_as(present)(values);
        }
        else if constexpr (std::is_same_v<T, Quat>) { return accept::unit_quaternions()(values); }
        else if constexpr (std::is_same_v<T, double>)
        {
            if (name == "stiffness") { return accepted_stiffness(bodies)(values); }
            return name == "weight" ? accept::finite()(values) : accept::same_as(present)(values);
        }
        else if (name == "inertia") { return accept::same_as(present)(values); }
        else if (name == "position") { return accept::within(-furthest, furthest)(values); }
        else if (name == "force" || name == "torque") { return accept::finite()(values); }
        else { return accept::within(-fastest, fastest)(values); }
    };
}

/// Accepts commands that a named body can have received.
auto commands_that_can_be()
{
    const auto flag = [](double value) { return value == 0 || value == 1; };
    return accept::all(accept::finite(), accept::each("a command of a body",
                                                      [flag](const CommandRow& row)
                                                      {
                                                          return flag(row.given) && flag(row.has_spin) &&
                                                                 flag(row.has_forward) && flag(row.has_lowering) &&
                                                                 row.locked >= 0 && row.locked <= freedoms &&
                                                                 row.locked == std::floor(row.locked);
                                                      }));
}

/// Number of nodes of a body's surface.
std::int64_t nodes_of(const world::World& world, std::int64_t body)
{
    const auto shape = static_cast<std::size_t>(world.bodies.shape[static_cast<std::size_t>(body)]);
    return static_cast<std::int64_t>(world.templates[shape].nodes.positions.size());
}

/// Accepts keys of two bodies, or of a body and a wall; with `listed`, in ascending order.
auto accepted_keys(const world::World& world, bool listed)
{
    const auto        bodies = static_cast<std::int64_t>(world.bodies.size());
    const auto        sides  = bodies + static_cast<std::int64_t>(world.planes.size());
    const std::string pair   = fmt::format("the key of two of {} bodies and walls, the first a body", sides);
    const auto        is_key = [=](std::uint64_t key)
    {
        const std::int64_t a = dem::first_of(key), b = dem::second_of(key);
        return a < bodies && a < b && b < sides;
    };
    return [=](const std::vector<std::uint64_t>& values) -> accept::Verdict
    {
        if (auto refusal = accept::each(pair, is_key)(values)) { return refusal; }
        return listed ? accept::ascending()(values) : accept::Verdict{};
    };
}

/// Accepts, for each pair, nodes of its bodies: i of the first, ~i of the second. `first`: start of each pair's nodes.
auto accepted_nodes(const world::World& world, const std::vector<std::uint64_t>& keys,
                    const std::vector<std::int32_t>& first)
{
    return [&](const std::vector<std::int32_t>& values) -> accept::Verdict
    {
        for (std::size_t pair = 0; pair + 1 < first.size(); ++pair)
        {
            const std::int64_t a = dem::first_of(keys[pair]), b = dem::second_of(keys[pair]);
            const bool         wall = b >= static_cast<std::int64_t>(world.bodies.size());
            const std::int64_t high = nodes_of(world, a) - 1, low = wall ? 0 : -nodes_of(world, b);
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
void DemSolver<Exec>::transfer_bodies(StateFile& file)
{
    bodies_.for_each_field(
        [&](std::string_view name, auto& array)
        {
            auto present = array.to_host();
            if (!file.loads()) { present.clear(); }
            file.common(fmt::format("bodies/{}", name), array, accepted_field(name, std::move(present), world_.bodies));
        });
}

template<class Exec>
void DemSolver<Exec>::transfer(StateFile& file)
{
    if (!file.loads() && ranks_) { ranks_->collect(bodies_); }
    transfer_bodies(file);
    file.numbers("bodies/steps", partition_version_, checked_within_step_, commanded_speed_, overlap_, mean_time_,
                 substep_, command_work_);
    file.doubles("bodies/command_impulse", command_impulse_);
    transfer_commands(file);
    transfer_means(file);
    transfer_contacts(file);
    if (file.exact()) { transfer_lists(file); }
    else if (file.loads())
    {
        totals_.fill_zero(); // their increase was accounted for when the state was saved
        taken_  = read(exec_, totals_.data());
        listed_ = false;
    }
}

template<class Exec>
void DemSolver<Exec>::transfer_commands(StateFile& file)
{
    std::vector<CommandRow>   commands;
    std::vector<std::int32_t> released(released_.begin(), released_.end());
    for (const auto& command : commanded_) { commands.push_back(row_of(command)); }
    const auto named = static_cast<std::size_t>(named_);
    file.common("bodies/commanded", commands, accept::all(accept::rows(named), commands_that_can_be()));
    file.common("bodies/released", released, accept::all(accept::rows(named), accept::within(0, 1)));
    if (!file.loads()) { return; }
    std::transform(commands.begin(), commands.end(), commanded_.begin(), command_of);
    std::transform(released.begin(), released.end(), released_.begin(), [](std::int32_t value) { return value != 0; });
}

/// Transfers impulses; loading sums what each rank has recorded.
template<class Exec>
void DemSolver<Exec>::transfer_means(StateFile& file)
{
    std::vector<dem::ContactImpulse> impulses     = impulses_.to_host();
    const auto                       named        = static_cast<std::size_t>(named_);
    const auto                       of_each_rank = [named, own = file.exact()](const auto& values)
    {
        const bool whole = own || named == 0 ? values.size() == named : values.size() % named == 0;
        return whole ? accept::Verdict{} : accept::rows(named)(values);
    };
    file.own_or_all("bodies/impulse", impulses, accept::all(of_each_rank, accept::finite()));
    file.common("bodies/kept_impulse", kept_impulses_, accept::all(accept::rows(named), accept::finite()));
    if (!file.loads()) { return; }
    std::vector<dem::ContactImpulse> sums(named, {Vec3<double>::Zero(), Vec3<double>::Zero()});
    const bool                       mine = file.exact() || file.communicator().rank() == 0;
    for (std::size_t i = 0; mine && i < impulses.size(); ++i)
    {
        sums[i % named].linear += impulses[i].linear;
        sums[i % named].angular += impulses[i].angular;
    }
    impulses_.assign(sums);
}

/// Transfers the contact records of the listed pairs: as the previous list of one rank, or those of pairs whose
/// contact this rank evaluates.
template<class Exec>
void DemSolver<Exec>::transfer_contacts(StateFile& file)
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
    file.own_or_all("pairs/key", keys, accepted_keys(world_, file.exact()));
    const auto of_each_pair = accept::all(accept::rows(keys.size()), accept::finite());
    file.own_or_all("pairs/patch", patches, of_each_pair);
    file.own_or_all("pairs/rolling", rolling, of_each_pair);
    file.own_or_all("pairs/place", places, of_each_pair);
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
void DemSolver<Exec>::transfer_lists(StateFile& file)
{
    const auto count = static_cast<std::size_t>(bodies_.position.size());
    file.numbers("pairs/listed", listed_);
    const std::vector<std::uint64_t> keys = pairs_.key.to_host();
    // Without a list there are no rows.
    const auto of_each = [&](std::size_t rows, auto bound)
    {
        return [&, rows, bound](const auto& values)
        { return !listed_ && values.empty() ? accept::Verdict{} : accept::all(accept::rows(rows), bound)(values); };
    };
    std::vector<double>       peaks = pairs_.peak.to_host();
    std::vector<std::int32_t> first = pairs_.first_node.to_host();
    file.own("pairs/peak", peaks, of_each(keys.size(), accept::finite()));
    file.own("pairs/travel", pairs_.travel, of_each(count, accept::not_negative()));
    file.own("pairs/first_node", first, of_each(keys.size() + 1, accept::cuts()));
    const std::size_t nodes = first.empty() ? 0 : static_cast<std::size_t>(std::max(first.back(), 0));
    file.own("pairs/node", pairs_.node, accept::all(accept::rows(nodes), accepted_nodes(world_, keys, first)));
    file.own("pairs/several_first", pairs_.patches.several,
             accept::all(accept::ascending(), accept::index(keys.size())));
    file.own("bodies/position_at_search", displacements_.position, of_each(count, accept::finite()));
    file.own("bodies/orientation_at_search", displacements_.orientation, of_each(count, accept::unit_quaternions()));
    file.own("bodies/totals", totals_, accept::all(accept::rows(count), accept::finite()));
    file.doubles("bodies/taken", taken_);
    if (!file.loads() || !listed_) { return; }
    pairs_.first_node.assign(first);
    dem::resume_list(exec_, pairs_, bodies_.view());
    pairs_.peak.assign(peaks);
}

#define TREAD_INSTANTIATE(Exec) template void DemSolver<Exec>::transfer(StateFile&)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
