#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "decomp/exchange.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "solver/ranks/body_holding.hpp"
#include "solver/ranks/body_numbers.hpp"

namespace tread::solver
{

/// Bodies that this rank integrates together with others, and the exchange of the shares of their sums between the
/// holders (kernels/dem/motion/shared.hpp). Only the ranks that share a body take part.
template<class Exec>
class SharedBodies
{
public:
    explicit SharedBodies(decomp::Transport<Exec>& transport);

    /// Lists the bodies shared on each route, in the same order on both sides. `held`: ascending. Collective: all ranks
    /// count messages anew.
    void plan(const BodyHoldings& held, const BodyNumbers& numbers, const Communicator& communicator);

    /// Follows a change of this rank's rows.
    void take_rows(const BodyNumbers& numbers);

    /// Prepares for exchange_marks(), which a scene without sleep does not need; call before plan().
    void begin_marks(decomp::Transport<Exec>& transport) { mark_.emplace(transport, "shares of marks"); }

    std::int64_t    count() const { return body_.size(); }
    dem::SharedView view();

    void exchange_wrenches();
    void exchange_stiffness();
    void exchange_speeds();
    void exchange_marks();

private:
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

    std::vector<std::int32_t>   number_; ///< [count], ascending
    Array<Exec, std::int32_t>   body_;   ///< [count], rows, ascending
    Array<Exec, std::int32_t>   place_;  ///< [rows], index in body_; -1: not shared
    Array<Exec, std::int32_t>   first_;  ///< [count + 1], first share of each body
    Array<Exec, std::int32_t>   row_;    ///< row of each share
    Shares<dem::WrenchShare>    wrench_;
    Shares<dem::StiffnessShare> stiffness_;
    Shares<dem::NearSpeeds>     speed_;

    std::optional<Shares<std::int32_t>> mark_; ///< only where bodies may sleep
};

} // namespace tread::solver
