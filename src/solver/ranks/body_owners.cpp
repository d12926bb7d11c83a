#include "solver/ranks/body_owners.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/errors.hpp"
#include "decomp/combine.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "solver/ranks/page_loads.hpp"

namespace tread::solver
{
namespace
{

/// Spacings: hysteresis of ownership. A body this near to a page of its rank stays with it, so that bodies at a border
/// do not migrate back and forth with their contact records. The rank's search radius is enlarged by as much.
constexpr double owner_slack = 0.25;

/// Spacings: a decision lasts until a body has moved as far, so that bodies that hardly move cost a search nothing.
constexpr double decision_margin = 0.125;

/// Spacings: what may meet a body grows in such steps, and shrinks by no less than four.
constexpr double reach_step = 0.25;

double lasting(double last, double needed, double step)
{
    const double now = step * std::ceil(needed / step);
    return needed <= last && last <= now + 4 * step ? last : now;
}

std::vector<std::int32_t> every_rank(const Communicator& communicator)
{
    std::vector<std::int32_t> ranks(static_cast<std::size_t>(communicator.size()));
    std::iota(ranks.begin(), ranks.end(), 0);
    return ranks;
}

std::vector<std::uint8_t> jointed(const world::World& world)
{
    std::vector<std::uint8_t> is_jointed(static_cast<std::size_t>(world.bodies.named), 0);
    for (const dem::Joint& joint : world.joints)
    {
        for (const std::int32_t b : joint.body)
        {
            if (b != dem::joint_world) { is_jointed[static_cast<std::size_t>(b)] = 1; }
        }
    }
    return is_jointed;
}

} // namespace

BodyOwners::BodyOwners(const Communicator& communicator, const world::World& world)
    : communicator_(communicator)
    , lattice_(page_lattice_of(world))
    , numbers_(world.bodies.size())
    , is_jointed_(jointed(world))
    , always_(static_cast<std::int32_t>(std::max<std::int64_t>(world.bodies.named, 1)))
{
}

void BodyOwners::follow(const std::vector<std::uint64_t>& keys, const decomp::PageRanks& ranks,
                        const std::vector<std::uint8_t>& sand, std::int64_t version)
{
    ownership_.emplace(lattice_, keys, ranks, sand);
    pages_version_ = version;
}

void BodyOwners::set(std::vector<std::int32_t> numbers, std::vector<std::int32_t> roles)
{
    owned_  = {};
    unheld_ = 0;
    for (std::size_t row = 0; row < numbers.size(); ++row)
    {
        unheld_ += roles[row] == dem::role_none && numbers[row] >= always_ ? 1 : 0;
        if (roles[row] != dem::role_owner) { continue; }
        owned_.count += 1;
        owned_.sum += numbers[row];
    }
    numbers_ = BodyNumbers(std::move(numbers), numbers_.bodies());
    role_    = std::move(roles);
}

void BodyOwners::assign(const world::World& world)
{
    const std::size_t         count = world.bodies.size();
    std::vector<std::uint8_t> owns(count), wanted(count);
    for (std::size_t b = 0; b < count; ++b)
    {
        owns[b]   = ownership_->owner_of(world.bodies.position[b]) == communicator_.rank() ? 1 : 0;
        wanted[b] = owns[b] != 0 || b < static_cast<std::size_t>(always_) ? 1 : 0;
    }
    for (const world::ContactRecord& contact : world.contacts)
    {
        const auto a = static_cast<std::size_t>(dem::first_of(contact.key)),
                   b = static_cast<std::size_t>(dem::second_of(contact.key));
        if (b >= count || owns[a] == owns[b]) { continue; }
        wanted[a] = wanted[b] = 1;
    }
    std::vector<std::int32_t> numbers, roles;
    for (std::size_t b = 0; b < count; ++b)
    {
        if (wanted[b] == 0) { continue; }
        numbers.push_back(static_cast<std::int32_t>(b));
        roles.push_back(owns[b] != 0 ? dem::role_owner : dem::role_none);
    }
    set(std::move(numbers), std::move(roles));
}

void BodyOwners::take_all()
{
    std::vector<std::int32_t> roles(numbers_.bodies(), dem::role_none);
    for (std::size_t row = 0; row < role_.size(); ++row)
    {
        if (role_[row] != dem::role_owner) { continue; }
        roles[static_cast<std::size_t>(numbers_.number(static_cast<std::int64_t>(row)))] = dem::role_owner;
    }
    set(BodyNumbers(numbers_.bodies()).all(), std::move(roles));
}

void BodyOwners::restore(std::vector<std::int32_t> numbers, const std::vector<std::int32_t>& owned,
                         const BodyHoldings& held)
{
    const BodyNumbers         rows(numbers, numbers_.bodies());
    std::vector<std::int32_t> roles(numbers.size(), dem::role_none);
    for (const BodyHolding& body : held)
    {
        if (const auto row = rows.find_row(body.body)) { roles[static_cast<std::size_t>(*row)] = dem::role_ghost; }
    }
    for (const std::int32_t body : owned)
    {
        if (const auto row = rows.find_row(body)) { roles[static_cast<std::size_t>(*row)] = dem::role_owner; }
    }
    set(std::move(numbers), std::move(roles));
}

contact::BorderReach BodyOwners::lasting_reach(const contact::BorderReach& last, const std::array<double, 2>& met) const
{
    // A body may be so far from all pages of its owner.
    const double slack = (owner_slack + decision_margin) * lattice_.spacing;
    return {lasting(last.met_by_large, met[0] + slack, reach_step * lattice_.spacing),
            lasting(last.met_by_small, met[1] + slack, reach_step * lattice_.spacing), last.sand};
}

std::int32_t BodyOwners::next_owner(const contact::BorderBody& ball)
{
    const double near_by = std::min(owner_slack * lattice_.spacing, ball.radius);
    return ownership_->around(ball.position, {near_by, 0}).owner_before_all(communicator_.rank());
}

BodyOwners::Decision BodyOwners::decide_on(std::int32_t body, const contact::BorderBody& ball)
{
    const std::int32_t here   = communicator_.rank();
    const double       margin = decision_margin * lattice_.spacing;
    const mpm::Reach   reach{ball.reach.bodies + margin, ball.reach.sand + margin};
    if (static_cast<std::size_t>(body) < is_jointed_.size() && is_jointed_[static_cast<std::size_t>(body)] != 0)
    {
        return {next_owner(ball), every_rank(communicator_), reach};
    }
    const decomp::Vicinity around = ownership_->around(ball.position, reach);
    const mpm::Reach       inside = around.clear_of_others(here);
    if (inside.bodies > 0) { return {here, {here}, inside}; }
    Decision made{next_owner(ball), {}, reach};
    around.find_owners(made.holders);
    return made;
}

BorderDecisions BodyOwners::decide(const BodiesAtBorders& bodies, const BodyHoldings& held)
{
    const std::int32_t here = communicator_.rank();
    HoldingLookup      before(held, here);
    BorderDecisions    found;
    for (std::size_t i = 0; i < bodies.row.size(); ++i)
    {
        const auto body = static_cast<std::int32_t>(numbers_.number(bodies.row[i]));
        // The analyzer takes memory whose size it does not know for none.
        const Decision    made = decide_on(body, bodies.ball[i]); // NOLINT(clang-analyzer-core.NonNullParamChecker)
        const BodyHolding last = before.of(body), now{body, made.owner, made.holders};
        // Another owner decides next, and this rank knows nothing when it is the owner again.
        found.clear.push_back(made.owner == here ? contact::Clearance{bodies.ball[i].position, made.within}
                                                 : contact::Clearance{});
        if (now.owner != last.owner || !std::ranges::equal(now.holders, last.holders)) { found.changes.add(now); }
    }
    return found;
}

std::optional<RowChange> BodyOwners::take_roles(const BodyHoldings& changes, UnheldRows unheld)
{
    const std::int32_t              here   = communicator_.rank();
    const std::vector<std::int32_t> before = numbers_.all();
    std::vector<std::int32_t>       numbers, roles;
    auto                            next = changes.begin();
    const auto                      take = [&](std::int32_t body, std::int32_t role)
    {
        if (role == dem::role_none && unheld == UnheldRows::go && body >= always_) { return; }
        numbers.push_back(body);
        roles.push_back(role);
    };
    const auto take_change = [&]
    {
        const std::int32_t held = (*next).owner == here ? dem::role_owner : dem::role_ghost;
        take((*next).body, holds(*next, here) ? held : dem::role_none);
        ++next;
    };
    for (std::size_t row = 0; row < before.size(); ++row)
    {
        while (next != changes.end() && (*next).body < before[row]) { take_change(); }
        if (next != changes.end() && (*next).body == before[row]) { take_change(); }
        else { take(before[row], role_[row]); }
    }
    while (next != changes.end()) { take_change(); }
    std::optional<RowChange> change = change_between(before, numbers);
    set(std::move(numbers), std::move(roles));
    return change;
}

std::optional<std::array<double, 2>> BodyOwners::sums_if_complete(const std::array<double, 2>& values) const
{
    double sums[] = {owned_.count, owned_.sum, values[0], values[1]};
    decomp::combine(communicator_, sums, 4, 0);
    const auto all = static_cast<double>(numbers_.bodies());
    if (sums[0] != all || sums[1] != all * (all - 1) / 2) { return std::nullopt; }
    return {{sums[2], sums[3]}};
}

bool BodyOwners::are_complete() const { return sums_if_complete({}).has_value(); }

OwnerChanges BodyOwners::changes_of_all(const BodyHoldings& changes) const
{
    std::array<double, 2> number{};
    for (const BodyHolding& body : changes)
    {
        number[0] += 1;
        number[1] += body.owner == communicator_.rank() ? 0 : 1;
    }
    const std::optional<std::array<double, 2>> of_all = sums_if_complete(number);
    if (!of_all) { throw NumericalError("a body was lost on its way from rank to rank"); }
    return {(*of_all)[0] > 0, (*of_all)[1] > 0};
}

std::vector<std::int32_t> BodyOwners::owned() const
{
    std::vector<std::int32_t> bodies;
    for (std::size_t row = 0; row < role_.size(); ++row)
    {
        if (role_[row] != dem::role_owner) { continue; }
        bodies.push_back(static_cast<std::int32_t>(numbers_.number(static_cast<std::int64_t>(row))));
    }
    return bodies;
}

} // namespace tread::solver
