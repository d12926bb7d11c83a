#include "solver/ranks/body_ranks.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "decomp/combine.hpp"
#include "decomp/messages.hpp"
#include "solver/bodies/bounding_radii.hpp"
#include "solver/ranks/page_loads.hpp"

namespace tread::solver
{

template<class Exec>
BodyRanks<Exec>::BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach,
                           dem::Bodies<Exec>& bodies)
    : decomposition_(decomposition)
    , exec_(decomposition.transport.exec())
    , sand_reach_(sand_reach)
    , owners_(decomposition.communicator, world)
    , shared_(decomposition.transport, world.bodies.size())
    , borders_(exec_)
    , border_body_(exec_, "bodies at borders on the host")
    , border_ball_(exec_, "balls of bodies at borders on the host")
    , records_(exec_, world.bodies.size())
    , states_(decomposition.transport, "states of bodies")
    , arriving_(exec_, "bodies arriving")
{
    owners_.follow_pages(decomposition.owners);
    owners_.assign(world.bodies.position);
    bodies.role.assign(owners_.roles());
    contact::begin_borders(exec_, borders_, bounding_radii(world));
    shared_.plan({}, communicator());
}

template<class Exec>
void BodyRanks<Exec>::sum_wanted_displacement(dem::Pairs<Exec>& pairs) const
{
    double wanted = read(exec_, pairs.measure.data());
    decomp::combine(communicator(), &wanted, 1, 0);
    copy_from_host(exec_, pairs.measure.data(), &wanted, sizeof(wanted));
}

template<class Exec>
void BodyRanks<Exec>::assign_owners(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs)
{
    if (pages_have_changed()) { follow_pages(); }
    const BodyHoldings    decided   = decide(bodies, pairs);
    ExchangedHoldings     exchanged = exchange_holdings(communicator(), decided);
    const dem::BodiesView view      = bodies.view();
    send_states(states_to_send(decided), exchanged.arriving,
                decomp::columns(view.position, view.orientation, view.velocity, view.angular_velocity, view.force,
                                view.torque, view.stiffness, view.locked, pairs.displacement.allowed.data()));
    const RoleChanges changes = owners_.take_roles(decided, exchanged.held);
    contact::set_roles(exec_, borders_, changes.body, changes.role, bodies);
    if (owners_.owner_has_changed(decided)) { records_.run(communicator(), pairs, is_large_, decided); }
    held_ = std::move(exchanged.held);
    shared_.plan(held_, communicator());
}

template<class Exec>
void BodyRanks<Exec>::follow_pages()
{
    owners_.follow_pages(decomposition_.owners);
    contact::forget_clearances(exec_, borders_);
}

template<class Exec>
void BodyRanks<Exec>::transfer(StateFile& file, dem::Bodies<Exec>& bodies)
{
    const std::int32_t        here  = communicator().rank();
    const std::size_t         count = owners_.roles().size();
    std::vector<std::int32_t> owned = owners_.owned();
    BodyHoldings              own;
    for (const BodyHolding& body : held_)
    {
        if (body.owner == here && body.holders.size() > 1) { own.add(body); }
    }
    std::vector<std::int32_t> words   = own.words();
    bool                      follows = !pages_have_changed();

    const auto held = [&](const std::vector<std::int32_t>& values) -> accept::Verdict
    {
        const auto read   = read_holdings(values, here, communicator().size(), count);
        bool       is_own = read.has_value();
        for (const BodyHolding& body : read.value_or(BodyHoldings()))
        {
            is_own = is_own && std::binary_search(owned.begin(), owned.end(), body.body);
        }
        if (is_own) { return {}; }
        return accept::Refusal{-1, "other words", "body, owner, number of holders and holders of shared bodies"};
    };
    file.own("ranks/body", owned, accept::all(accept::index(count), accept::ascending(), accept::distinct()));
    file.own("ranks/holders", words, held);
    file.numbers("ranks/follows_pages", follows);
    if (!file.loads()) { return; }

    held_ = exchange_holdings(communicator(), read_holdings(words, here, communicator().size(), count).value()).held;
    owners_.restore(owned, held_);
    if (!owners_.are_complete())
    {
        file.refuse("ranks/body", {-1, "other bodies", fmt::format("each of {} bodies on one rank", count)});
    }
    bodies.role.assign(owners_.roles());
    shared_.plan(held_, communicator());
    if (follows) { follow_pages(); }
}

template<class Exec>
BodyHoldings BodyRanks<Exec>::decide(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs)
{
    if (is_large_.empty()) { is_large_ = pairs.sizes.is_large.to_host(); }
    std::array<double, 2> met = contact::largest_reaches(exec_, borders_, pairs, bodies.view());
    decomp::combine(communicator(), met.data(), 0, 2);
    const double slack = owners_.slack();
    contact::list_borders(exec_, borders_, pairs, bodies.view(), {met[0] + slack, met[1] + slack, sand_reach_});
    border_body_.request(borders_.body);
    border_ball_.request(borders_.ball);
    synchronize(exec_);
    BorderDecisions decided =
        owners_.decide({{border_body_.data(), border_body_.data() + borders_.body.size()}, border_ball_.data()});
    contact::keep_clearances(exec_, borders_, decided.inside, decided.clear);
    return std::move(decided.shared);
}

/// Bodies whose state this rank sends, by destination.
template<class Exec>
RankLists BodyRanks<Exec>::states_to_send(const BodyHoldings& decided) const
{
    RankLists lists(static_cast<std::size_t>(communicator().size()));
    for (const BodyHolding& body : decided)
    {
        for (const std::int32_t holder : body.holders)
        {
            if (holder != communicator().rank()) { lists[static_cast<std::size_t>(holder)].push_back(body.body); }
        }
    }
    return lists;
}

template<class Exec>
void BodyRanks<Exec>::send_states(const RankLists& leaving, const RankLists& arriving, const decomp::Columns& columns)
{
    arriving_.assign(joined(arriving));
    states_.plan(joined(leaving), routes_of(leaving), routes_of(arriving));
    states_.begin(columns);
    states_.finish(columns, arriving_);
}

template<class Exec>
double BodyRanks<Exec>::load() const
{
    return body_load * owners_.count();
}

template<class Exec>
void BodyRanks<Exec>::add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const
{
    const std::vector<Vec3<double>> position = bodies.position.to_host();
    for (const std::int32_t body : owners_.owned())
    {
        loads[owners_.page_of(position[static_cast<std::size_t>(body)])] += body_load;
    }
}

#define TREAD_INSTANTIATE(Exec) template class BodyRanks<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
