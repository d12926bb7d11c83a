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

/// The bodies of a scene over the ranks of a run: whose they are, who else holds which, and what holders tell each
/// other. A body belongs to the rank of the page that its centre is in when the pairs are found; the ranks whose pages
/// it may reach until they are found again, and the widest other beyond, hold it too. Calls are collective unless a
/// line says otherwise.
template<class Exec>
class BodyRanks
{
public:
    /// Bodies have their owners, and no guests before the first deal(). `sand_reach`: m, how far beyond its surface a
    /// body must be known to the owner of sand.
    BodyRanks(decomp::Decomposition<Exec>& decomposition, const world::World& world, double sand_reach,
              dem::Bodies<Exec>& bodies);

    /// Whether all ranks say so.
    bool all(bool value) const;

    /// Over the ranks; of what is not 0.
    double largest(double value) const;
    double shortest(double value) const;

    /// A struct of doubles that becomes the sum of all ranks', in their order.
    template<class Row>
    void sum(Row& row) const
    {
        static_assert(sizeof(Row) % sizeof(double) == 0);
        decomp::combine(communicator_, reinterpret_cast<double*>(&row), sizeof(Row) / sizeof(double), 0);
    }

    /// Between dem::request_displacement and dem::allow_displacement: what all ranks' bodies want.
    void sum_wanted_travel(dem::Pairs<Exec>& pairs) const;

    /// Between dem::allow_displacement and dem::list_pairs: bodies go to the rank that they have moved to, with what
    /// their contacts remember, and guests to where they may be met.
    void assign_owners(dem::Bodies<Exec>& bodies, dem::Pairs<Exec>& pairs);

    /// Where no rank shares a body with another, nothing is ever sent. Not collective: of those that share some.
    void exchange_wrenches() { pass_on(wrench_); }
    void exchange_stiffness() { pass_on(stiffness_); }
    void exchange_speeds() { pass_on(speed_); }

    /// Every rank knows the state of all bodies, until they move.
    void collect(dem::Bodies<Exec>& bodies);

    // Not collective.
    /// Predicted work of this rank's bodies, in points, and on which pages it is.
    double          load() const;
    void            add_loads(const dem::Bodies<Exec>& bodies, decomp::PageLoads& loads) const;
    bool            pages_have_changed() const { return pages_known_ != decomposition_.owners.changes(); }
    bool            owns(std::int64_t body) const { return role_[static_cast<std::size_t>(body)] == dem::role_owner; }
    bool            shares() const { return shared_body_.size() > 0; }
    dem::SharedView shared();

    /// The body of a pair whose owner answers it.
    std::int64_t decider(const std::vector<std::int32_t>& is_large, std::uint64_t key) const;

    const Communicator& communicator() const { return communicator_; }

private:
    /// Who owns and who holds a body from now on, where that is not this rank alone.
    struct Holding
    {
        std::int32_t              body;
        std::int32_t              owner;
        std::vector<std::int32_t> holders; ///< ascending; the owner among them
    };
    using Lists = std::vector<std::vector<std::int32_t>>; ///< of each rank

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
    std::int64_t                         pages_known_ = 0; ///< changes of the map of pages that the ownership has
    std::optional<decomp::PageOwnership> ownership_;
    std::vector<double>                  bounding_radius_; ///< m, by body
    std::vector<std::int32_t>            role_;            ///< by body
    std::vector<decomp::Surroundings>    inside_;          ///< by body: where it was last seen inside this rank's pages
    std::vector<std::int32_t>            is_large_;        ///< by body, of Pairs; empty before the first deal()
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
