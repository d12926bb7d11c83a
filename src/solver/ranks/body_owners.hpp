#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "decomp/page_map.hpp"
#include "decomp/page_ownership.hpp"
#include "solver/ranks/body_holding.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Data of the last search for pairs that the distribution of bodies depends on, on the host; one entry per body.
struct SearchedBodies
{
    const Vec3<double>*              position;             ///< m
    const double*                    allowed_displacement; ///< m, until the next search for pairs
    const std::vector<std::int32_t>& is_large;             ///< dem::BodySizes::is_large
};

/// Roles of this rank for the bodies of a scene, and the decision who owns and who holds each body, on the host. A body
/// is owned by the rank of the page that holds its centre when pairs are found. Ranks whose pages it may reach before
/// the next search, enlarged by the largest search radius of any other body, hold it as a ghost.
class BodyOwners
{
public:
    /// `sand_reach`: m, distance beyond a body's surface within which the owner of sand must hold the body. Call
    /// follow_pages() and assign() before anything else.
    BodyOwners(const Communicator& communicator, const world::World& world, double sand_reach);

    /// Uses the present owners of pages from now on.
    template<class Exec>
    void follow_pages(const decomp::PageMap<Exec>& pages)
    {
        follow(pages.keys(), pages.ranks(), pages.changes());
    }

    /// PageMap::changes() at the last follow_pages().
    std::int64_t pages_version() const { return pages_version_; }

    /// Gives each body to the owner of its page; there are no ghosts.
    void assign(const std::vector<Vec3<double>>& position);

    /// Decides about the bodies that this rank has owned until now; those that it alone still holds are left out.
    /// Collective.
    std::vector<BodyHolding> decide(const SearchedBodies& searched);

    /// Takes the roles of exchanged decisions.
    void take_roles(const std::vector<BodyHolding>& decided, const std::vector<BodyHolding>& held);

    /// Whether any body of any rank has got a new owner by these decisions. Collective; NumericalError if the ranks
    /// together do not own every body once.
    bool owner_has_changed(const std::vector<BodyHolding>& decided) const;

    /// dem::BodyRole of every body.
    const std::vector<std::int32_t>& roles() const { return role_; }

    bool                      owns(std::int64_t body) const;
    std::vector<std::int32_t> owned() const; ///< ascending

    /// Page that holds a position (m).
    std::uint64_t page_of(const Vec3<double>& position) const { return ownership_->page_of(position); }

private:
    void         follow(const std::vector<std::uint64_t>& keys, const decomp::PageRanks& ranks, std::int64_t version);
    bool         is_inside(std::size_t body, const decomp::Surroundings& around);
    std::int32_t next_owner(std::size_t body, const Vec3<double>& position);

    const Communicator&                  communicator_;
    decomp::PageLattice                  lattice_;
    double                               sand_reach_;        ///< m
    std::int64_t                         pages_version_ = 0; ///< of the page map that `ownership_` was built from
    std::optional<decomp::PageOwnership> ownership_;
    std::vector<double>                  bounding_radius_; ///< m, by body
    std::vector<std::int32_t>            role_;            ///< by body
    std::vector<std::uint8_t>            is_jointed_;      ///< by body: 1 = every rank holds it, and solves its joints
    std::vector<decomp::Surroundings>    inside_;          ///< by body: last surroundings inside this rank's pages
};

} // namespace tread::solver
