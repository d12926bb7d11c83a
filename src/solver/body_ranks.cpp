#include "solver/body_ranks.hpp"

#include <algorithm>
#include <utility>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "decomp/combine.hpp"
#include "decomp/messages.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"
#include "solver/page_loads.hpp"

namespace tread::solver
{
namespace
{

constexpr std::int32_t alone = -1; ///< place of a body that only one rank holds

/// Spacings: hysteresis of ownership. A body this near to a page of its rank stays with it, so that bodies at a border
/// do not migrate back and forth with their contact records. The rank's search radius is enlarged by as much.
constexpr double owner_slack = 0.25;

/// Writes a body's part of a message: body, owner, number of holders, holders.
void write_words(std::vector<std::int32_t>& words, std::int32_t body, std::int32_t owner,
                 const std::vector<std::int32_t>& holders)
{
    words.insert(words.end(), {body, owner, static_cast<std::int32_t>(holders.size())});
    words.insert(words.end(), holders.begin(), holders.end());
}

std::vector<decomp::Route> routes_of(const std::vector<std::vector<std::int32_t>>& lists)
{
    std::vector<decomp::Route> routes;
    for (std::size_t r = 0; r < lists.size(); ++r)
    {
        if (!lists[r].empty()) { routes.push_back({static_cast<int>(r), static_cast<std::int64_t>(lists[r].size())}); }
    }
    return routes;
}

std::vector<std::int32_t> joined(const std::vector<std::vector<std::int32_t>>& lists)
{
    std::vector<std::int32_t> all;
    for (const auto& list : lists) { all.insert(all.end(), list.begin(), list.end()); }
    return all;
}

} // namespace

template<class Exec>
BodyRanks<Exec>::BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach,
                           dem::Bodies<Exec>& bodies)
    : communicator_(decomposition.communicator)
    , decomposition_(decomposition)
    , lattice_(page_lattice_of(world))
    , exec_(decomposition.transport.exec())
    , sand_reach_(sand_reach)
    , position_(exec_, "body positions on the host")
    , travel_(exec_, "body travel on the host")
    , states_(decomposition.transport, "states of bodies")
    , arriving_(exec_, "bodies arriving")
    , shared_body_(exec_, "shared bodies")
    , shared_place_(exec_, "places of shared bodies")
    , shared_first_(exec_, "shares of bodies")
    , shared_row_(exec_, "rows of shares")
    , wrench_(decomposition.transport, "shares of wrenches")
    , stiffness_(decomposition.transport, "shares of stiffness")
    , speed_(decomposition.transport, "shares of speeds")
{
    role_.resize(world.bodies.size());
    look_at_pages();
    const std::int32_t here = communicator_.rank();
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        const auto& form = world.templates[static_cast<std::size_t>(world.bodies.shape[b])];
        bounding_radius_.push_back(form.bounding_radius * world.bodies.scale[b]);
        role_[b] = ownership_->owner_of(world.bodies.position[b]) == here ? dem::role_owner : dem::role_none;
    }
    bodies.role.assign(role_);
    plan_sharing({});
}

template<class Exec>
void BodyRanks<Exec>::look_at_pages()
{
    ownership_.emplace(lattice_, decomposition_.owners.keys(), decomposition_.owners.ranks());
    pages_known_ = decomposition_.owners.changes();
    inside_.assign(role_.size(), decomp::Surroundings{});
}

template<class Exec>
bool BodyRanks<Exec>::all(bool value) const
{
    return communicator_.maximum(value ? 0 : 1) == 0;
}

template<class Exec>
double BodyRanks<Exec>::largest(double value) const
{
    decomp::combine(communicator_, &value, 0, 1);
    return value;
}

template<class Exec>
double BodyRanks<Exec>::shortest(double value) const
{
    double least = 0;
    for (const double other : communicator_.gather(value))
    {
        if (other > 0 && (least == 0 || other < least)) { least = other; }
    }
    return least;
}

template<class Exec>
void BodyRanks<Exec>::sum_wanted_travel(dem::Pairs<Exec>& pairs) const
{
    double wanted = read(exec_, pairs.measure.data());
    decomp::combine(communicator_, &wanted, 1, 0);
    copy_from_host(exec_, pairs.measure.data(), &wanted, sizeof(wanted));
}

template<class Exec>
void BodyRanks<Exec>::assign_owners(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs)
{
    if (pages_have_changed()) { look_at_pages(); }
    const std::vector<Holding> decided = decide(bodies, pairs);
    Lists                      leaving(rank_count()), arriving(rank_count());
    for (const Holding& body : decided)
    {
        for (const std::int32_t holder : body.holders)
        {
            if (holder != communicator_.rank()) { leaving[static_cast<std::size_t>(holder)].push_back(body.body); }
        }
    }
    const std::vector<Holding> held = tell(decided, arriving);
    send_states(bodies, pairs, leaving, arriving);
    if (take_roles(bodies, decided, held)) { hand_over_records(pairs, decided); }
    plan_sharing(held);
}

template<class Exec>
std::int32_t BodyRanks<Exec>::next_owner(std::size_t body, const Vec3<double>& place)
{
    const std::int32_t              own   = communicator_.rank();
    const double                    slack = std::min(owner_slack * lattice_.spacing, bounding_radius_[body]);
    const std::vector<std::int32_t> near  = ownership_->owners_near(place, slack);
    return std::find(near.begin(), near.end(), own) != near.end() ? own : ownership_->owner_of(place);
}

/// Whether this rank owns all pages around one of its bodies. Cached: most bodies have the same surroundings as at the
/// last check.
template<class Exec>
bool BodyRanks<Exec>::is_inside(std::size_t body, const decomp::Surroundings& around)
{
    if (inside_[body] == around) { return true; }
    if (!ownership_->is_within(around, communicator_.rank())) { return false; }
    inside_[body] = around;
    return true;
}

/// Decides owner and holders of the bodies that this rank has owned until now; bodies that it alone still holds are
/// left out.
template<class Exec>
auto BodyRanks<Exec>::decide(const dem::Bodies<Exec>& bodies, const dem::Pairs<Exec>& pairs) -> std::vector<Holding>
{
    position_.request(bodies.position);
    travel_.request(pairs.travel);
    if (is_large_.empty()) { is_large_ = pairs.is_large.to_host(); }
    synchronize(exec_);

    double met[2] = {}; // m, largest search radius of all bodies, and of small ones
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] != dem::role_owner) { continue; }
        met[0] = std::max(met[0], reach_of(b));
        if (is_large_[b] == 0) { met[1] = std::max(met[1], reach_of(b)); }
    }
    decomp::combine(communicator_, met, 0, 2);

    const double         slack = owner_slack * lattice_.spacing;
    std::vector<Holding> decided;
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] != dem::role_owner) { continue; }
        const Vec3<double>& place = position_.data()[b];
        const double        reach = reach_of(b) + std::max(met[is_large_[b] != 0 ? 0 : 1] + slack, sand_reach_);
        if (is_inside(b, ownership_->surroundings(place, reach))) { continue; }
        std::vector<std::int32_t> holders = ownership_->owners_near(place, reach);
        if (holders.size() == 1 && holders.front() == communicator_.rank()) { continue; }
        decided.push_back({static_cast<std::int32_t>(b), next_owner(b, place), std::move(holders)});
    }
    return decided;
}

/// Exchanges the decisions. Returns the bodies that this rank shares from now on, ascending; `arriving`: by rank, the
/// bodies whose state it sends.
template<class Exec>
auto BodyRanks<Exec>::tell(const std::vector<Holding>& decided, Lists& arriving) const -> std::vector<Holding>
{
    Lists                words(rank_count());
    std::vector<Holding> held;
    for (const Holding& body : decided)
    {
        for (const std::int32_t holder : body.holders)
        {
            if (holder == communicator_.rank()) { held.push_back(body); }
            else { write_words(words[static_cast<std::size_t>(holder)], body.body, body.owner, body.holders); }
        }
    }
    const Lists told = decomp::exchange_values(communicator_, words);
    for (std::size_t r = 0; r < told.size(); ++r)
    {
        for (auto word = told[r].begin(); word != told[r].end();)
        {
            const auto holders = word + 3, end = holders + word[2];
            held.push_back({word[0], word[1], {holders, end}});
            arriving[r].push_back(word[0]);
            word = end;
        }
    }
    std::sort(held.begin(), held.end(), [](const Holding& a, const Holding& b) { return a.body < b.body; });
    return held;
}

template<class Exec>
void BodyRanks<Exec>::send_states(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs, const Lists& leaving,
                                  const Lists& arriving)
{
    arriving_.assign(joined(arriving));
    states_.plan(joined(leaving), routes_of(leaving), routes_of(arriving));
    const dem::BodiesView view = bodies.view();
    const decomp::Columns columns =
        decomp::columns(view.position, view.orientation, view.velocity, view.angular_velocity, view.force, view.torque,
                        view.stiffness, view.locked, pairs.travel.data());
    states_.begin(columns);
    states_.finish(columns, arriving_);
}

/// Updates the roles. Returns whether any body of any rank has a new owner.
template<class Exec>
bool BodyRanks<Exec>::take_roles(dem::Bodies<Exec>& bodies, const std::vector<Holding>& decided,
                                 const std::vector<Holding>& held)
{
    for (std::int32_t& role : role_) { role = role == dem::role_owner ? role : dem::role_none; }
    for (const Holding& body : decided) { role_[static_cast<std::size_t>(body.body)] = dem::role_none; }
    for (const Holding& body : held)
    {
        const bool own                             = body.owner == communicator_.rank();
        role_[static_cast<std::size_t>(body.body)] = own ? dem::role_owner : dem::role_guest;
    }
    bodies.role.assign(role_);
    double owned = 0, sum_of_owned = 0, leaving = 0; // integers, exact in double
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] != dem::role_owner) { continue; }
        ++owned;
        sum_of_owned += static_cast<double>(b);
    }
    for (const Holding& body : decided) { leaving += body.owner == communicator_.rank() ? 0 : 1; }
    double sums[] = {owned, sum_of_owned, leaving};
    decomp::combine(communicator_, sums, 3, 0);
    const auto count = static_cast<double>(role_.size());
    if (sums[0] != count || sums[1] != count * (count - 1) / 2)
    {
        throw NumericalError("a body was lost on its way from rank to rank");
    }
    return sums[2] > 0;
}

/// Lists the bodies shared on each route, in the same order on both sides.
template<class Exec>
void BodyRanks<Exec>::plan_sharing(const std::vector<Holding>& held)
{
    std::vector<std::int32_t> body, first{0}, place(role_.size(), alone);
    Lists                     rows(rank_count());
    for (const Holding& one : held)
    {
        if (one.holders.size() < 2) { continue; }
        const auto row                            = static_cast<std::int32_t>(body.size());
        place[static_cast<std::size_t>(one.body)] = row;
        body.push_back(one.body);
        first.push_back(first.back() + static_cast<std::int32_t>(one.holders.size()));
        for (const std::int32_t holder : one.holders) { rows[static_cast<std::size_t>(holder)].push_back(row); }
    }
    rows[rank()].clear();

    std::vector<std::int32_t> next(rank_count(), static_cast<std::int32_t>(body.size()));
    for (std::size_t r = 1; r < next.size(); ++r)
    {
        next[r] = next[r - 1] + static_cast<std::int32_t>(rows[r - 1].size());
    }
    std::vector<std::int32_t> share;
    for (const Holding& one : held)
    {
        if (one.holders.size() < 2) { continue; }
        for (const std::int32_t holder : one.holders)
        {
            const auto r = static_cast<std::size_t>(holder);
            share.push_back(r == rank() ? place[static_cast<std::size_t>(one.body)] : next[r]++);
        }
    }
    shared_body_.assign(body);
    shared_place_.assign(place);
    shared_first_.assign(first);
    shared_row_.assign(share);

    const auto prepare = [&](auto& shares)
    {
        shares.exchange.plan(joined(rows), routes_of(rows), routes_of(rows));
        shares.rows.resize(shared_body_.size() + shares.exchange.received());
    };
    prepare(wrench_);
    prepare(stiffness_);
    prepare(speed_);
}

template<class Exec>
template<class Share>
void BodyRanks<Exec>::pass_on(Shares<Share>& shares)
{
    const decomp::Columns columns = decomp::columns(shares.rows.data());
    shares.exchange.begin(columns);
    shares.exchange.finish(columns, shared_body_.size());
}

template<class Exec>
dem::SharedView BodyRanks<Exec>::shared()
{
    return {shared_body_.size(), shared_body_.data(), shared_place_.data(),   shared_first_.data(),
            shared_row_.data(),  wrench_.rows.data(), stiffness_.rows.data(), speed_.rows.data()};
}

template<class Exec>
void BodyRanks<Exec>::collect(dem::Bodies<Exec>& bodies)
{
    std::vector<std::int32_t> own;
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] == dem::role_owner) { own.push_back(static_cast<std::int32_t>(b)); }
    }
    Lists arriving = decomp::gather_values(communicator_, own), leaving(rank_count(), own);
    arriving[rank()].clear();
    leaving[rank()].clear();
    arriving_.assign(joined(arriving));
    states_.plan(joined(leaving), routes_of(leaving), routes_of(arriving));
    const dem::BodiesView view = bodies.view();
    const decomp::Columns columns =
        decomp::columns(view.position, view.orientation, view.velocity, view.angular_velocity);
    states_.begin(columns);
    states_.finish(columns, arriving_);
}

template<class Exec>
double BodyRanks<Exec>::load() const
{
    return body_load * static_cast<double>(std::count(role_.begin(), role_.end(), dem::role_owner));
}

template<class Exec>
void BodyRanks<Exec>::add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const
{
    const std::vector<Vec3<double>> position = bodies.position.to_host();
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] == dem::role_owner) { loads[ownership_->page_of(position[b])] += body_load; }
    }
}

template<class Exec>
std::int64_t BodyRanks<Exec>::decider(const std::vector<std::int32_t>& is_large, std::uint64_t key) const
{
    const std::int64_t a = dem::first_of(key), b = dem::second_of(key);
    return b < static_cast<std::int64_t>(role_.size()) ? dem::decider_of(is_large.data(), a, b) : a;
}

#define TREAD_INSTANTIATE(Exec) template class BodyRanks<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
