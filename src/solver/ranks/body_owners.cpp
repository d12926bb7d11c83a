#include "solver/ranks/body_owners.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/errors.hpp"
#include "decomp/combine.hpp"
#include "kernels/dem/bodies.hpp"
#include "solver/bodies/bounding_radii.hpp"
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
    std::vector<std::uint8_t> is_jointed(world.bodies.size(), 0);
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
    , bounding_radius_(bounding_radii(world))
    , role_(world.bodies.size())
    , is_jointed_(jointed(world))
{
}

void BodyOwners::follow(const std::vector<std::uint64_t>& keys, const decomp::PageRanks& ranks,
                        const std::vector<std::uint8_t>& sand, std::int64_t version)
{
    ownership_.emplace(lattice_, keys, ranks, sand);
    pages_version_ = version;
}

void BodyOwners::Owned::add(std::int32_t body, std::int32_t role, double sign)
{
    if (role != dem::role_owner) { return; }
    count += sign;
    sum += sign * static_cast<double>(body);
}

void BodyOwners::assign(const std::vector<Vec3<double>>& position)
{
    const std::int32_t here = communicator_.rank();
    ghosts_.clear();
    owned_ = {};
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        role_[b] = ownership_->owner_of(position[b]) == here ? dem::role_owner : dem::role_none;
        owned_.add(static_cast<std::int32_t>(b), role_[b], 1);
    }
}

void BodyOwners::restore(const std::vector<std::int32_t>& owned, const BodyHoldings& held)
{
    std::fill(role_.begin(), role_.end(), dem::role_none);
    ghosts_.clear();
    owned_ = {};
    for (const std::int32_t body : owned)
    {
        role_[static_cast<std::size_t>(body)] = dem::role_owner;
        owned_.add(body, dem::role_owner, 1);
    }
    for (const BodyHolding& body : held)
    {
        std::int32_t& role = role_[static_cast<std::size_t>(body.body)];
        if (role == dem::role_owner) { continue; }
        role = dem::role_ghost;
        ghosts_.push_back(body.body);
    }
}

double BodyOwners::slack() const { return owner_slack * lattice_.spacing; }

std::int32_t BodyOwners::next_owner(std::size_t body, const Vec3<double>& position)
{
    const std::int32_t own     = communicator_.rank();
    const double       near_by = std::min(slack(), bounding_radius_[body]);
    return ownership_->around(position, {near_by, 0}).owner_before_all(own);
}

BorderDecisions BodyOwners::decide(const BodiesAtBorders& bodies)
{
    const std::int32_t              here = communicator_.rank();
    const std::vector<std::int32_t> all  = every_rank(communicator_);
    std::vector<std::int32_t>       holders;
    BorderDecisions                 found;
    for (std::size_t i = 0; i < bodies.body.size(); ++i)
    {
        const std::int32_t         body = bodies.body[i];
        const auto                 b    = static_cast<std::size_t>(body);
        const contact::BorderBody& ball = bodies.ball[i];
        if (is_jointed_[b] != 0)
        {
            if (all.size() > 1) { found.shared.add({body, next_owner(b, ball.position), all}); }
            continue;
        }
        const decomp::Vicinity around = ownership_->around(ball.position, ball.reach);
        const mpm::Reach       clear  = around.clear_of_others(here);
        if (clear.bodies > 0)
        {
            found.inside.push_back(body);
            found.clear.push_back({ball.position, clear});
            continue;
        }
        around.find_owners(holders);
        if (holders.size() == 1 && holders.front() == here) { continue; }
        found.shared.add({body, next_owner(b, ball.position), holders});
    }
    return found;
}

RoleChanges BodyOwners::take_roles(const BodyHoldings& decided, const BodyHoldings& held)
{
    std::vector<std::int32_t> mine, before; // decided about; these, and ghosts
    for (const BodyHolding& body : decided) { mine.push_back(body.body); }
    std::set_union(ghosts_.begin(), ghosts_.end(), mine.begin(), mine.end(), std::back_inserter(before));
    ghosts_.clear();

    RoleChanges changes;
    const auto  take = [&](std::int32_t body, std::int32_t role)
    {
        std::int32_t& present = role_[static_cast<std::size_t>(body)];
        if (present == role) { return; }
        owned_.add(body, present, -1);
        owned_.add(body, role, 1);
        present = role;
        changes.body.push_back(body);
        changes.role.push_back(role);
    };
    auto next = before.begin();
    for (const BodyHolding& body : held)
    {
        for (; next != before.end() && *next < body.body; ++next) { take(*next, dem::role_none); }
        if (next != before.end() && *next == body.body) { ++next; }
        const bool own = body.owner == communicator_.rank();
        take(body.body, own ? dem::role_owner : dem::role_ghost);
        if (!own) { ghosts_.push_back(body.body); }
    }
    for (; next != before.end(); ++next) { take(*next, dem::role_none); }
    return changes;
}

std::optional<double> BodyOwners::sum_if_complete(double value) const
{
    double sums[] = {owned_.count, owned_.sum, value};
    decomp::combine(communicator_, sums, 3, 0);
    const auto all = static_cast<double>(role_.size());
    if (sums[0] != all || sums[1] != all * (all - 1) / 2) { return std::nullopt; }
    return sums[2];
}

bool BodyOwners::are_complete() const { return sum_if_complete(0).has_value(); }

bool BodyOwners::owner_has_changed(const BodyHoldings& decided) const
{
    double leaving = 0;
    for (const BodyHolding& body : decided) { leaving += body.owner == communicator_.rank() ? 0 : 1; }
    const std::optional<double> of_all = sum_if_complete(leaving);
    if (!of_all) { throw NumericalError("a body was lost on its way from rank to rank"); }
    return *of_all > 0;
}

bool BodyOwners::owns(std::int64_t body) const { return role_[static_cast<std::size_t>(body)] == dem::role_owner; }

std::vector<std::int32_t> BodyOwners::owned() const
{
    std::vector<std::int32_t> bodies;
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] == dem::role_owner) { bodies.push_back(static_cast<std::int32_t>(b)); }
    }
    return bodies;
}

} // namespace tread::solver
