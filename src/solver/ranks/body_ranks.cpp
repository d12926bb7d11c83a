#include "solver/ranks/body_ranks.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "decomp/combine.hpp"
#include "kernels/dem/sleep/sleep.hpp"
#include "solver/ranks/page_loads.hpp"
#include "solver/ranks/row_arrays.hpp"

namespace tread::solver
{
namespace
{

/// All of a body's state that other ranks need, of which some never changes.
template<class Exec>
decomp::Columns state_columns(const RowArrays<Exec>& arrays)
{
    const dem::BodiesView view    = arrays.bodies.view();
    decomp::Columns       columns = decomp::columns(
              view.position, view.orientation, view.velocity, view.angular_velocity, view.mass, view.inertia, view.scale,
              view.shape, view.material, view.locked, view.damped, view.force, view.torque, view.stiffness,
              arrays.pairs.displacement.allowed.data(), arrays.pairs.displacement.drift.data(),
              arrays.pairs.sizes.node_area.data(), arrays.pairs.sizes.is_large.data(), arrays.bounding_radii.data());
    if (arrays.inertia_factor != nullptr) { columns.add(decomp::rows(arrays.inertia_factor->data())); }
    if (!arrays.pairs.sleep.wanted) { return columns; }
    columns.add(decomp::rows(view.asleep));
    arrays.pairs.sleep.for_each_state([&](auto& array) { columns.add(decomp::rows(array.data())); });
    return columns;
}

/// Rows without one before get the values of the first.
std::vector<std::int32_t> any_for_new(std::vector<std::int32_t> from)
{
    for (std::int32_t& row : from) { row = std::max(row, 0); }
    return from;
}

std::vector<std::int32_t> negative(const std::vector<std::int32_t>& values)
{
    std::vector<std::int32_t> places;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        if (values[i] < 0) { places.push_back(static_cast<std::int32_t>(i)); }
    }
    return places;
}

bool has(const std::vector<std::int32_t>& ascending, std::int32_t body)
{
    return std::binary_search(ascending.begin(), ascending.end(), body);
}

/// Accepts numbers of rows, ascending, that begin with those of the first bodies.
auto holds_first(std::int32_t first)
{
    return [first](const std::vector<std::int32_t>& numbers) -> accept::Verdict
    {
        const auto count = static_cast<std::size_t>(first);
        if (numbers.size() >= count && numbers[count - 1] == first - 1) { return {}; }
        return accept::Refusal{-1, "other bodies", fmt::format("the first {} among them", first)};
    };
}

/// Refuses a file that lacks a row of a body that the rank holds.
void require_rows(const StateFile& file, const std::vector<std::int32_t>& present, const BodyHoldings& held)
{
    const auto require = [&]
    {
        for (const BodyHolding& body : held)
        {
            if (has(present, body.body)) { continue; }
            file.refuse("ranks/row",
                        {-1, fmt::format("no row of body {}", body.body), "one of each body that it holds"});
        }
    };
    on_every_rank(file.communicator(), require);
}

} // namespace

template<class Exec>
BodyRanks<Exec>::BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach)
    : decomposition_(decomposition)
    , exec_(decomposition.transport.exec())
    , reach_{0, 0, sand_reach}
    , owners_(decomposition.communicator, world)
    , shared_(decomposition.transport)
    , borders_(exec_)
    , border_body_(exec_, "bodies at borders on the host")
    , border_ball_(exec_, "balls of bodies at borders on the host")
    , records_(exec_)
    , states_(decomposition.transport, "states of bodies")
    , arriving_(exec_, "bodies arriving")
{
    owners_.follow_pages(decomposition.owners);
    owners_.assign(world);
    contact::begin_borders(exec_, borders_, static_cast<std::int64_t>(numbers().rows()));
}

template<class Exec>
void BodyRanks<Exec>::take_all()
{
    owners_.take_all();
    held_ = {};
    contact::begin_borders(exec_, borders_, static_cast<std::int64_t>(numbers().rows()));
}

template<class Exec>
void BodyRanks<Exec>::write_rows(dem::Bodies<Exec>& bodies)
{
    bodies.role.assign(owners_.roles());
    bodies.number.assign(numbers().all());
    shared_.plan(held_, numbers(), communicator());
}

template<class Exec>
void BodyRanks<Exec>::sum_wanted_displacement(dem::Pairs<Exec>& pairs) const
{
    double wanted = read(exec_, pairs.measure.data());
    decomp::combine(communicator(), &wanted, 1, 0);
    copy_from_host(exec_, pairs.measure.data(), &wanted, sizeof(wanted));
}

template<class Exec>
void BodyRanks<Exec>::assign_owners(const RowArrays<Exec>& arrays, UnheldRows unheld)
{
    if (pages_have_changed()) { follow_pages(); }
    const BodyHoldings decided = decide(arrays);
    const OwnerChanges change  = owners_.changes_of_all(decided);
    moves_.reset();
    if (change.holders) { exchange_bodies(arrays, decided, change, unheld); }
    else if (owners_.has_unheld() && unheld == UnheldRows::go)
    {
        take_roles(arrays, {}, unheld);
        shared_.take_rows(numbers());
    }
    if (moves_) { dem::list_large_bodies(exec_, arrays.pairs); }
}

template<class Exec>
void BodyRanks<Exec>::exchange_bodies(const RowArrays<Exec>& arrays, const BodyHoldings& decided, OwnerChanges change,
                                      UnheldRows unheld)
{
    // 1. Owners tell the holders, until now and from now on.
    const HoldingChanges changes = exchange_changes(communicator(), decided, held_);
    // 2. States and contact records leave from the rows before.
    states_.plan(numbers().rows_of(joined(changes.leaving)), routes_of(changes.leaving), routes_of(changes.arriving));
    states_.begin(state_columns(arrays));
    if (change.owners)
    {
        records_.take(communicator(), arrays.pairs, numbers(), decided);
        if (arrays.pairs.sleep.wanted) { sleepers_.take(communicator(), arrays.pairs, numbers(), decided); }
    }
    // 3. Rows go and come.
    held_ = changed(held_, changes.all, communicator().rank());
    take_roles(arrays, changes.all, unheld);
    shared_.plan(held_, numbers(), communicator());
    // 4. States and records arrive.
    arriving_.assign(numbers().rows_of(joined(changes.arriving)));
    states_.finish(state_columns(arrays), arriving_);
    if (change.owners)
    {
        records_.send(communicator(), arrays.pairs, numbers());
        if (arrays.pairs.sleep.wanted) { sleepers_.send(communicator(), arrays.pairs, numbers()); }
    }
}

/// Takes the roles that change, and the rows of bodies that come and go.
template<class Exec>
void BodyRanks<Exec>::take_roles(const RowArrays<Exec>& arrays, const BodyHoldings& changes, UnheldRows unheld)
{
    std::optional<RowChange> change = owners_.take_roles(changes, unheld);
    if (change) { move_rows(arrays, std::move(*change)); }
    arrays.bodies.role.assign(owners_.roles());
}

template<class Exec>
void BodyRanks<Exec>::move_rows(const RowArrays<Exec>& arrays, RowChange change)
{
    RowMoves<Exec>& moves = moves_.emplace(exec_);
    moves.come            = negative(change.from);
    moves.gone            = negative(change.to);
    moves.from.assign(any_for_new(std::move(change.from)));
    moves.to.assign(change.to);
    const auto take = [&](auto& array) { take_rows(exec_, moves.from, array); };
    arrays.bodies.for_each_field(
        [&](std::string_view field, auto& array)
        {
            if (field != "weight") { take(array); } // of named bodies, whose rows stay
        });
    take(arrays.pairs.displacement.allowed);
    take(arrays.pairs.displacement.drift);
    take(arrays.pairs.sizes.node_area);
    take(arrays.pairs.sizes.is_large);
    take(arrays.bounding_radii);
    if (arrays.inertia_factor != nullptr) { take(*arrays.inertia_factor); }
    take(borders_.clear);
    contact::keep_clearances(exec_, borders_, moves.come, std::vector<contact::Clearance>(moves.come.size()));
    arrays.bodies.number.assign(numbers().all());
    dem::renumber_records(exec_, arrays.pairs, moves.to, moves.from.size());
    if (arrays.pairs.sleep.wanted) { move_sleepers(arrays, moves); }
}

template<class Exec>
void BodyRanks<Exec>::move_sleepers(const RowArrays<Exec>& arrays, const RowMoves<Exec>& moves)
{
    dem::SleepingBodies<Exec>& sleep = arrays.pairs.sleep;
    take_rows(exec_, moves.from, arrays.bodies.asleep);
    sleep.for_each_state([&](auto& array) { take_rows(exec_, moves.from, array); });
    sleep.resize_sand(moves.from.size());
    dem::renumber_sleeping_pairs(exec_, arrays.pairs, moves.to, moves.from.size());
}

template<class Exec>
void BodyRanks<Exec>::follow_pages()
{
    owners_.follow_pages(decomposition_.owners);
    contact::forget_clearances(exec_, borders_);
}

/// Holdings of bodies that this rank owns and shares.
template<class Exec>
BodyHoldings BodyRanks<Exec>::own_shared() const
{
    BodyHoldings own;
    for (const BodyHolding& body : held_)
    {
        if (body.owner == communicator().rank() && body.holders.size() > 1) { own.add(body); }
    }
    return own;
}

template<class Exec>
void BodyRanks<Exec>::transfer(StateFile& file)
{
    const std::size_t         count   = numbers().bodies();
    std::vector<std::int32_t> present = numbers().all(), owned = owners_.owned(), words = own_shared().words();
    bool                      follows = !pages_have_changed();

    const auto read = [&](const std::vector<std::int32_t>& values)
    { return read_holdings(values, communicator().rank(), communicator().size(), count); };
    const auto holders = [&](const std::vector<std::int32_t>& values) -> accept::Verdict
    {
        const std::optional<BodyHoldings> found  = read(values);
        bool                              is_own = found.has_value();
        for (const BodyHolding& body : found.value_or(BodyHoldings())) { is_own = is_own && has(owned, body.body); }
        if (is_own) { return {}; }
        return accept::Refusal{-1, "other words", "body, owner, number of holders and holders of shared bodies"};
    };
    const auto numbers_of_bodies = accept::all(accept::index(count), accept::ascending(), accept::distinct());
    const auto of_present        = [&](std::int32_t body) { return has(present, body); };
    file.own("ranks/row", present, accept::all(numbers_of_bodies, holds_first(owners_.always())));
    file.own("ranks/body", owned, accept::all(numbers_of_bodies, accept::each("a body with a row", of_present)));
    file.own("ranks/holders", words, holders);
    file.numbers("ranks/follows_pages", follows);
    file.numbers("ranks/reach", reach_.met_by_large, reach_.met_by_small);
    std::vector<contact::Clearance> clear = borders_.clear.to_host();
    file.own("ranks/clear", clear, accept::all(accept::rows(present.size()), accept::finite()));
    if (!file.loads()) { return; }

    held_ = exchange_holdings(communicator(), read(words).value());
    require_rows(file, present, held_);
    owners_.restore(std::move(present), owned, held_);
    borders_.clear.assign(clear);
    if (!owners_.are_complete())
    {
        file.refuse("ranks/body", {-1, "other bodies", fmt::format("each of {} bodies on one rank", count)});
    }
    if (follows) { owners_.follow_pages(decomposition_.owners); }
}

template<class Exec>
contact::BorderReach BodyRanks<Exec>::border_reach(const RowArrays<Exec>& arrays)
{
    std::array<double, 2> met =
        contact::largest_reaches(exec_, arrays.bounding_radii.data(), arrays.pairs, arrays.bodies.view());
    decomp::combine(communicator(), met.data(), 0, 2);
    return owners_.lasting_reach(reach_, met);
}

template<class Exec>
BodyHoldings BodyRanks<Exec>::decide(const RowArrays<Exec>& arrays)
{
    const contact::BorderReach reach = border_reach(arrays);
    if (reach.met_by_large < reach_.met_by_large || reach.met_by_small < reach_.met_by_small)
    {
        contact::forget_clearances(exec_, borders_); // made while bodies reached further than what now may meet them
    }
    reach_ = reach;
    contact::list_borders(exec_, borders_, arrays.bounding_radii.data(), arrays.pairs, arrays.bodies.view(), reach_);
    if (borders_.body.size() == 0) { return {}; }
    border_body_.request(borders_.body);
    border_ball_.request(borders_.ball);
    synchronize(exec_);
    const BodiesAtBorders listed{{border_body_.data(), border_body_.data() + borders_.body.size()},
                                 border_ball_.data()};
    BorderDecisions       decided = owners_.decide(listed, held_);
    contact::keep_clearances(exec_, borders_, listed.row, decided.clear);
    return std::move(decided.changes);
}

template<class Exec>
double BodyRanks<Exec>::load(double asleep) const
{
    return body_load * (owners_.count() - asleep) + body_load_asleep * asleep;
}

template<class Exec>
void BodyRanks<Exec>::add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const
{
    const std::vector<Vec3<double>> position = bodies.position.to_host();
    std::vector<std::int32_t>       asleep   = bodies.asleep.to_host();
    asleep.resize(position.size(), 0);
    for (std::size_t row = 0; row < position.size(); ++row)
    {
        if (!owns(static_cast<std::int64_t>(row))) { continue; }
        loads[owners_.page_of(position[row])] += asleep[row] != 0 ? body_load_asleep : body_load;
    }
}

#define TREAD_INSTANTIATE(Exec) template class BodyRanks<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
