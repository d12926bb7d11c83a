#include "solver/ranks/body_owners.hpp"

#include <algorithm>
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
    owned_ = {};
    for (std::size_t row = 0; row < numbers.size(); ++row)
    {
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

double BodyOwners::slack() const { return owner_slack * lattice_.spacing; }

std::int32_t BodyOwners::next_owner(const contact::BorderBody& ball)
{
    const double near_by = std::min(slack(), ball.radius);
    return ownership_->around(ball.position, {near_by, 0}).owner_before_all(communicator_.rank());
}

BorderDecisions BodyOwners::decide(const BodiesAtBorders& bodies)
{
    const std::int32_t              here = communicator_.rank();
    const std::vector<std::int32_t> all  = every_rank(communicator_);
    std::vector<std::int32_t>       holders;
    BorderDecisions                 found;
    for (std::size_t i = 0; i < bodies.row.size(); ++i)
    {
        const auto                 body = static_cast<std::int32_t>(numbers_.number(bodies.row[i]));
        const auto                 b    = static_cast<std::size_t>(body);
        const contact::BorderBody& ball = bodies.ball[i];
        if (b < is_jointed_.size() && is_jointed_[b] != 0)
        {
            if (all.size() > 1) { found.shared.add({body, next_owner(ball), all}); }
            continue;
        }
        const decomp::Vicinity around = ownership_->around(ball.position, ball.reach);
        const mpm::Reach       clear  = around.clear_of_others(here);
        if (clear.bodies > 0)
        {
            found.inside.push_back(bodies.row[i]);
            found.clear.push_back({ball.position, clear});
            continue;
        }
        around.find_owners(holders);
        if (holders.size() == 1 && holders.front() == here) { continue; }
        found.shared.add({body, next_owner(ball), holders});
    }
    return found;
}

std::optional<RowChange> BodyOwners::take_roles(const BodyHoldings& decided, const BodyHoldings& held,
                                                UnheldRows unheld)
{
    const std::vector<std::int32_t> before = numbers_.all();
    std::vector<std::int32_t>       numbers, roles;
    auto                            next      = held.begin();
    auto                            mine      = decided.begin();
    const auto                      take_held = [&]
    {
        numbers.push_back((*next).body);
        roles.push_back((*next).owner == communicator_.rank() ? dem::role_owner : dem::role_ghost);
        ++next;
    };
    for (std::size_t row = 0; row < before.size(); ++row)
    {
        const std::int32_t body = before[row];
        while (next != held.end() && (*next).body < body) { take_held(); }
        while (mine != decided.end() && (*mine).body < body) { ++mine; }
        if (next != held.end() && (*next).body == body)
        {
            take_held();
            continue;
        }
        const bool left = role_[row] == dem::role_ghost || (mine != decided.end() && (*mine).body == body);
        const auto role = left ? static_cast<std::int32_t>(dem::role_none) : role_[row];
        if (role == dem::role_none && unheld == UnheldRows::go && body >= always_) { continue; }
        numbers.push_back(body);
        roles.push_back(role);
    }
    while (next != held.end()) { take_held(); }
    std::optional<RowChange> change = change_between(before, numbers);
    set(std::move(numbers), std::move(roles));
    return change;
}

std::optional<double> BodyOwners::sum_if_complete(double value) const
{
    double sums[] = {owned_.count, owned_.sum, value};
    decomp::combine(communicator_, sums, 3, 0);
    const auto all = static_cast<double>(numbers_.bodies());
    if (sums[0] != all || sums[1] != all * (all - 1) / 2) { return std::nullopt; }
    return sums[2];
}

bool BodyOwners::are_complete() const { return sum_if_complete(0).has_value(); }

bool BodyOwners::owner_changes(const BodyHoldings& decided) const
{
    double leaving = 0;
    for (const BodyHolding& body : decided) { leaving += body.owner == communicator_.rank() ? 0 : 1; }
    const std::optional<double> of_all = sum_if_complete(leaving);
    if (!of_all) { throw NumericalError("a body was lost on its way from rank to rank"); }
    return *of_all > 0;
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
