#include "solver/ranks/shared_bodies.hpp"

#include <utility>

#include "backend/instantiate.hpp"
#include "kernels/contact/borders.hpp"

namespace tread::solver
{
namespace
{

/// The bodies of a plan, the row of each for every holder, and where each body's shares begin.
struct SharingPlan
{
    std::vector<std::int32_t> body, first{0}, share;
    RankLists                 rows; ///< by rank: rows to send, in ascending order of bodies
};

SharingPlan list_bodies(const BodyHoldings& held, std::size_t ranks)
{
    SharingPlan plan;
    plan.rows.resize(ranks);
    for (const BodyHolding& one : held)
    {
        if (one.holders.size() < 2) { continue; }
        const auto row = static_cast<std::int32_t>(plan.body.size());
        plan.body.push_back(one.body);
        plan.first.push_back(plan.first.back() + static_cast<std::int32_t>(one.holders.size()));
        for (const std::int32_t holder : one.holders) { plan.rows[static_cast<std::size_t>(holder)].push_back(row); }
    }
    return plan;
}

/// Numbers the rows of shares: this rank's own come first, then those that arrive, by rank. plan.rows has none for this
/// rank.
void number_shares(SharingPlan& plan, const BodyHoldings& held, std::size_t rank)
{
    std::vector<std::int32_t> next(plan.rows.size(), static_cast<std::int32_t>(plan.body.size()));
    for (std::size_t r = 1; r < next.size(); ++r)
    {
        next[r] = next[r - 1] + static_cast<std::int32_t>(plan.rows[r - 1].size());
    }
    std::int32_t place = 0;
    for (const BodyHolding& one : held)
    {
        if (one.holders.size() < 2) { continue; }
        for (const std::int32_t holder : one.holders)
        {
            const auto r = static_cast<std::size_t>(holder);
            plan.share.push_back(r == rank ? place : next[r]++);
        }
        ++place;
    }
}

} // namespace

template<class Exec>
SharedBodies<Exec>::SharedBodies(decomp::Transport<Exec>& transport)
    : body_(transport.exec(), "shared bodies")
    , place_(transport.exec(), "places of shared bodies")
    , first_(transport.exec(), "shares of bodies")
    , row_(transport.exec(), "rows of shares")
    , wrench_(transport, "shares of wrenches")
    , stiffness_(transport, "shares of stiffness")
    , speed_(transport, "shares of speeds")
{
}

template<class Exec>
void SharedBodies<Exec>::plan(const BodyHoldings& held, const BodyNumbers& numbers, const Communicator& communicator)
{
    const auto  rank  = static_cast<std::size_t>(communicator.rank());
    SharingPlan found = list_bodies(held, static_cast<std::size_t>(communicator.size()));
    found.rows[rank].clear();
    number_shares(found, held, rank);
    number_ = std::move(found.body);
    take_rows(numbers);
    first_.assign(found.first);
    row_.assign(found.share);

    const std::vector<std::int32_t>  rows    = joined(found.rows);
    const std::vector<decomp::Route> routes  = routes_of(found.rows);
    const auto                       prepare = [&](auto& shares)
    {
        shares.exchange.plan(rows, routes, routes);
        shares.rows.resize(body_.size() + shares.exchange.received());
    };
    prepare(wrench_);
    prepare(stiffness_);
    prepare(speed_);
    if (mark_) { prepare(*mark_); }
}

template<class Exec>
void SharedBodies<Exec>::take_rows(const BodyNumbers& numbers)
{
    body_.assign(numbers.rows_of(number_));
    place_.resize(static_cast<std::int64_t>(numbers.rows()));
    contact::forget_places(place_.exec(), place_);
    contact::write_places(place_.exec(), body_, place_);
}

template<class Exec>
template<class Share>
void SharedBodies<Exec>::pass_on(Shares<Share>& shares)
{
    const decomp::Columns columns = decomp::columns(shares.rows.data());
    shares.exchange.begin(columns);
    shares.exchange.finish(columns, body_.size());
}

template<class Exec>
dem::SharedView SharedBodies<Exec>::view()
{
    return {body_.size(),           body_.data(),       place_.data(),
            first_.data(),          row_.data(),        wrench_.rows.data(),
            stiffness_.rows.data(), speed_.rows.data(), mark_ ? mark_->rows.data() : nullptr};
}

template<class Exec>
void SharedBodies<Exec>::exchange_wrenches()
{
    pass_on(wrench_);
}

template<class Exec>
void SharedBodies<Exec>::exchange_stiffness()
{
    pass_on(stiffness_);
}

template<class Exec>
void SharedBodies<Exec>::exchange_speeds()
{
    pass_on(speed_);
}

template<class Exec>
void SharedBodies<Exec>::exchange_marks()
{
    pass_on(*mark_);
}

#define TREAD_INSTANTIATE(Exec) template class SharedBodies<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
