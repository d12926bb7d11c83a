#include "solver/ranks/body_owners.hpp"

#include <algorithm>
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

BodyOwners::BodyOwners(const Communicator& communicator, const world::World& world, double sand_reach)
    : communicator_(communicator)
    , lattice_(page_lattice_of(world))
    , sand_reach_(sand_reach)
    , bounding_radius_(bounding_radii(world))
    , role_(world.bodies.size())
    , is_jointed_(jointed(world))
{
}

void BodyOwners::follow(const std::vector<std::uint64_t>& keys, const decomp::PageRanks& ranks, std::int64_t version)
{
    ownership_.emplace(lattice_, keys, ranks);
    pages_version_ = version;
    inside_.assign(role_.size(), decomp::Surroundings{});
}

void BodyOwners::assign(const std::vector<Vec3<double>>& position)
{
    const std::int32_t here = communicator_.rank();
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        role_[b] = ownership_->owner_of(position[b]) == here ? dem::role_owner : dem::role_none;
    }
}

std::int32_t BodyOwners::next_owner(std::size_t body, const Vec3<double>& position)
{
    const std::int32_t              own   = communicator_.rank();
    const double                    slack = std::min(owner_slack * lattice_.spacing, bounding_radius_[body]);
    const std::vector<std::int32_t> near  = ownership_->owners_near(position, slack);
    return std::find(near.begin(), near.end(), own) != near.end() ? own : ownership_->owner_of(position);
}

/// Whether this rank owns all pages around one of its bodies. Cached: most bodies have the same surroundings as at the
/// last check.
bool BodyOwners::is_inside(std::size_t body, const decomp::Surroundings& around)
{
    if (inside_[body] == around) { return true; }
    if (!ownership_->is_within(around, communicator_.rank())) { return false; }
    inside_[body] = around;
    return true;
}

std::vector<BodyHolding> BodyOwners::decide(const SearchedBodies& searched)
{
    const auto own_reach = [&](std::size_t b) { return bounding_radius_[b] + searched.allowed_displacement[b]; };
    double     met[2]    = {}; // m, largest search radius of all bodies, and of small ones
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] != dem::role_owner) { continue; }
        met[0] = std::max(met[0], own_reach(b));
        if (searched.is_large[b] == 0) { met[1] = std::max(met[1], own_reach(b)); }
    }
    decomp::combine(communicator_, met, 0, 2);

    const double             slack = owner_slack * lattice_.spacing;
    std::vector<BodyHolding> decided;
    for (std::size_t b = 0; b < role_.size(); ++b)
    {
        if (role_[b] != dem::role_owner) { continue; }
        const Vec3<double>& position = searched.position[b];
        const double radius     = own_reach(b) + std::max(met[searched.is_large[b] != 0 ? 0 : 1] + slack, sand_reach_);
        const bool   everywhere = is_jointed_[b] != 0;
        if (!everywhere && is_inside(b, ownership_->surroundings(position, radius))) { continue; }
        std::vector<std::int32_t> holders =
            everywhere ? every_rank(communicator_) : ownership_->owners_near(position, radius);
        if (holders.size() == 1 && holders.front() == communicator_.rank()) { continue; }
        decided.push_back({static_cast<std::int32_t>(b), next_owner(b, position), std::move(holders)});
    }
    return decided;
}

void BodyOwners::take_roles(const std::vector<BodyHolding>& decided, const std::vector<BodyHolding>& held)
{
    for (std::int32_t& role : role_) { role = role == dem::role_owner ? role : dem::role_none; }
    for (const BodyHolding& body : decided) { role_[static_cast<std::size_t>(body.body)] = dem::role_none; }
    for (const BodyHolding& body : held)
    {
        const bool own                             = body.owner == communicator_.rank();
        role_[static_cast<std::size_t>(body.body)] = own ? dem::role_owner : dem::role_ghost;
    }
}

bool BodyOwners::owner_has_changed(const std::vector<BodyHolding>& decided) const
{
    double count = 0, sum = 0, leaving = 0; // integers, exact in double
    for (const std::int32_t body : owned())
    {
        ++count;
        sum += static_cast<double>(body);
    }
    for (const BodyHolding& body : decided) { leaving += body.owner == communicator_.rank() ? 0 : 1; }
    double sums[] = {count, sum, leaving};
    decomp::combine(communicator_, sums, 3, 0);
    const auto all = static_cast<double>(role_.size());
    if (sums[0] != all || sums[1] != all * (all - 1) / 2)
    {
        throw NumericalError("a body was lost on its way from rank to rank");
    }
    return sums[2] > 0;
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
