#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "decomp/page_map.hpp"
#include "decomp/page_ownership.hpp"
#include "kernels/contact/borders.hpp"
#include "kernels/dem/bodies.hpp"
#include "solver/ranks/body_holding.hpp"
#include "solver/ranks/body_numbers.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Bodies that the owner decides about, and the ball of each within which other ranks matter.
struct BodiesAtBorders
{
    std::vector<std::int32_t>  row;  ///< ascending
    const contact::BorderBody* ball; ///< of each
};

/// Decisions of this rank about bodies at borders.
struct BorderDecisions
{
    BodyHoldings                    changes; ///< of owner or holders
    std::vector<contact::Clearance> clear;   ///< how long the decision about each body lasts
};

/// What a search for pairs changes, on any rank.
struct OwnerChanges
{
    bool holders; ///< of a body
    bool owners;  ///< likewise
};

/// What becomes of the rows of bodies that a rank does not hold any more.
enum class UnheldRows
{
    go,
    stay ///< lists of this step may still name them
};

/// Bodies of this rank and its roles for them, and the decision who owns and who holds each body, on the host. A body
/// is owned by the rank of the page that holds its centre. Ranks whose pages it may reach before the next search,
/// enlarged by the largest search radius of any other body, hold it as a ghost, and so do those whose sand it may
/// touch. A decision is made for somewhat larger balls and lasts until the body may leave them. Named bodies (or the
/// first, where there is none) have rows on every rank. BodyHoldings and owned() have numbers of bodies.
class BodyOwners
{
public:
    /// Call follow_pages() and assign() before anything else.
    BodyOwners(const Communicator& communicator, const world::World& world);

    /// Uses the present owners of pages from now on.
    template<class Exec>
    void follow_pages(const decomp::PageMap<Exec>& pages)
    {
        follow(pages.keys(), pages.ranks(), pages.sand(), pages.changes());
    }

    /// PageMap::changes() at the last follow_pages().
    std::int64_t pages_version() const { return pages_version_; }

    /// Gives each body to the owner of its page at the start; there are no ghosts. Bodies that touch them then have
    /// rows, too.
    void assign(const world::World& world);

    /// Gives every body a row; owners stay, and there are no ghosts.
    void take_all();

    /// Takes the bodies that this rank had rows for when a state was saved, those of them that it owned, and the
    /// holders of those that it shared.
    void restore(std::vector<std::int32_t> numbers, const std::vector<std::int32_t>& owned, const BodyHoldings& held);

    /// Decides about bodies that this rank has owned until now. `held`: bodies that it has shared until now.
    BorderDecisions decide(const BodiesAtBorders& bodies, const BodyHoldings& held);

    /// Takes the roles and rows of all changes that concern this rank; returns how rows change, empty where they do
    /// not.
    std::optional<RowChange> take_roles(const BodyHoldings& changes, UnheldRows unheld);

    /// Whether rows of bodies that this rank does not hold any more are left.
    bool has_unheld() const { return unheld_ > 0; }

    /// What may meet a body, a little more than needed so that decisions last while displacements change. `met`: m,
    /// largest own reach of all ranks' bodies, and of their small ones; `last`: of the last search.
    contact::BorderReach lasting_reach(const contact::BorderReach& last, const std::array<double, 2>& met) const;

    /// Whether the ranks together own every body once. Collective.
    bool are_complete() const;

    /// What these decisions, which are not taken yet, and those of the other ranks change. Collective; NumericalError
    /// if the ranks together do not own every body once.
    OwnerChanges changes_of_all(const BodyHoldings& changes) const;

    const BodyNumbers& numbers() const { return numbers_; }

    /// Number of the scene's first bodies, which have rows on every rank.
    std::int32_t always() const { return always_; }

    /// dem::BodyRole of every row.
    const std::vector<std::int32_t>& roles() const { return role_; }

    bool owns(std::int64_t row) const { return role_[static_cast<std::size_t>(row)] == dem::role_owner; }
    std::vector<std::int32_t> owned() const; ///< ascending
    double                    count() const { return owned_.count; }

    /// Page that holds a position (m).
    std::uint64_t page_of(const Vec3<double>& position) const { return ownership_->page_of(position); }

private:
    struct Decision
    {
        std::int32_t              owner;
        std::vector<std::int32_t> holders; ///< ascending
        mpm::Reach                within;  ///< m, balls within which it lasts
    };

    void         follow(const std::vector<std::uint64_t>& keys, const decomp::PageRanks& ranks,
                        const std::vector<std::uint8_t>& sand, std::int64_t version);
    std::int32_t next_owner(const contact::BorderBody& ball);
    Decision     decide_on(std::int32_t body, const contact::BorderBody& ball);
    void         set(std::vector<std::int32_t> numbers, std::vector<std::int32_t> roles);

    /// Sums over ranks; empty if the ranks together do not own every body once. Collective.
    std::optional<std::array<double, 2>> sums_if_complete(const std::array<double, 2>& values) const;

    /// Number and sum of the numbers of the bodies that this rank owns: integers, exact in double.
    struct Owned
    {
        double count = 0;
        double sum   = 0;
    };

    const Communicator&                  communicator_;
    decomp::PageLattice                  lattice_;
    std::int64_t                         pages_version_ = 0; ///< of the page map that `ownership_` was built from
    std::optional<decomp::PageOwnership> ownership_;
    BodyNumbers                          numbers_;
    std::vector<std::int32_t>            role_;       ///< by row
    std::vector<std::uint8_t>            is_jointed_; ///< by named body: 1 = every rank holds it, and solves its joints
    std::int32_t                         always_;     ///< number of first bodies with rows on every rank
    Owned                                owned_;
    std::int64_t                         unheld_ = 0; ///< number of rows that only the present step's lists need
};

} // namespace tread::solver
