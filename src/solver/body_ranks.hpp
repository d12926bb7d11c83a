#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "backend/fetched_array.hpp"
#include "decomp/balance.hpp"
#include "decomp/combine.hpp"
#include "decomp/decomposition.hpp"
#include "decomp/exchange.hpp"
#include "decomp/page_ownership.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Distribution of a scene's bodies over the ranks: ownership, ghosts, and exchange between the holders of a body. A
/// body is owned by the rank of the page that holds its centre when pairs are found. Ranks whose pages it may reach
/// before the next search, enlarged by the largest search radius of any other body, hold it as a ghost. Calls are
/// collective unless a comment says otherwise.
template<class Exec>
class BodyRanks
{
public:
    /// Sets the owners; there are no ghosts before the first assign_owners(). `sand_reach`: m, distance beyond a
    /// body's surface within which the owner of sand must know the body.
    BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach,
              dem::Bodies<Exec>& bodies);

    /// Whether `value` is true on all ranks.
    bool all(bool value) const;

    /// Global maximum and minimum over ranks; zeros are ignored.
    double largest(double value) const;
    double shortest(double value) const;

    /// Sums a struct of doubles over all ranks, in rank order.
    template<class Row>
    void sum(Row& row) const
    {
        static_assert(sizeof(Row) % sizeof(double) == 0);
        decomp::combine(communicator_, reinterpret_cast<double*>(&row), sizeof(Row) / sizeof(double), 0);
    }

    /// Sums the requested displacements of all ranks' bodies. Call between dem::request_displacement and
    /// dem::allow_displacement.
    void sum_wanted_travel(dem::Pairs<Exec>& pairs) const;

    /// Moves bodies, with their contact records, to the ranks that now own them, and sends ghosts to the ranks where
    /// they may be in contact. Call between dem::allow_displacement and dem::list_pairs.
    void assign_owners(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs);

    /// Exchanges of shared bodies. Not collective: only the ranks that share a body take part.
    void exchange_wrenches() { pass_on(wrench_); }
    void exchange_stiffness() { pass_on(stiffness_); }
    void exchange_speeds() { pass_on(speed_); }

    /// Gathers the state of all bodies on every rank; valid until they move.
    void collect(dem::Bodies<Exec>& bodies);

    // Not collective.
    /// Predicted work of this rank's bodies, in points, in total and by page.
    double          load() const;
    void            add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const;
    bool            pages_have_changed() const { return pages_known_ != decomposition_.owners.changes(); }
    bool            owns(std::int64_t body) const { return role_[static_cast<std::size_t>(body)] == dem::role_owner; }
    bool            shares() const { return shared_body_.size() > 0; }
    dem::SharedView shared();

    /// The body of a pair whose owner evaluates the contact.
    std::int64_t decider(const std::vector<std::int32_t>& is_large, std::uint64_t key) const;

    const Communicator& communicator() const { return communicator_; }

private:
    /// Owner and holders of a body that is not held by this rank alone.
    struct Holding
    {
        std::int32_t              body;
        std::int32_t              owner;
        std::vector<std::int32_t> holders; ///< ascending; the owner among them
    };
    using Lists = std::vector<std::vector<std::int32_t>>; ///< one list per rank

    void                 look_at_pages();
    std::vector<Holding> decide(const dem::Bodies<Exec>& bodies, const dem::Pairs<Exec>& pairs);
    double               reach_of(std::size_t body) const { return bounding_radius_[body] + travel_.data()[body]; }
    bool                 is_inside(std::size_t body, const decomp::Surroundings& around);
    std::int32_t         next_owner(std::size_t body, const Vec3<double>& place);
    std::vector<Holding> tell(const std::vector<Holding>& decided, Lists& arriving) const;
    void send_states(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs, const Lists& leaving, const Lists& arriving);
    void hand_over_records(dem::Pairs<Exec>& pairs, const std::vector<Holding>& decided);
    bool take_roles(dem::Bodies<Exec>& bodies, const std::vector<Holding>& decided, const std::vector<Holding>& held);
    void plan_sharing(const std::vector<Holding>& held);

    template<class Share>
    struct Shares
    {
        Shares(decomp::Transport<Exec>& transport, const char* name)
            : rows(transport.exec(), name)
            , exchange(transport, name)
        {
        }

        Array<Exec, Share>     rows;
        decomp::Exchange<Exec> exchange;
    };

    template<class Share>
    void pass_on(Shares<Share>& shares);

    std::size_t                  rank() const { return static_cast<std::size_t>(communicator_.rank()); }
    std::size_t                  rank_count() const { return static_cast<std::size_t>(communicator_.size()); }
    const Communicator&          communicator_;
    decomp::Decomposition<Exec>& decomposition_;
    decomp::PageLattice          lattice_;
    Exec                         exec_;

    double                               sand_reach_;
    std::int64_t                         pages_known_ = 0; ///< version of the page map that `ownership_` was built from
    std::optional<decomp::PageOwnership> ownership_;
    std::vector<double>                  bounding_radius_; ///< m, by body
    std::vector<std::int32_t>            role_;            ///< by body
    std::vector<decomp::Surroundings>    inside_;          ///< by body: last surroundings inside this rank's pages
    std::vector<std::int32_t>            is_large_;        ///< by body, from Pairs; empty before assign_owners()
    FetchedArray<Exec, Vec3<double>>     position_;        ///< m
    FetchedArray<Exec, double>           travel_;          ///< m
    decomp::Exchange<Exec>               states_;
    Array<Exec, std::int32_t>            arriving_;
    Array<Exec, std::int32_t>            shared_body_;
    Array<Exec, std::int32_t>            shared_place_;
    Array<Exec, std::int32_t>            shared_first_;
    Array<Exec, std::int32_t>            shared_row_;
    Shares<dem::WrenchShare>             wrench_;
    Shares<dem::StiffnessShare>          stiffness_;
    Shares<double>                       speed_;
};

} // namespace tread::solver
