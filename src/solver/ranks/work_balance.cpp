#include "solver/ranks/work_balance.hpp"

#include <utility>

#include "backend/backends.hpp"
#include "backend/instantiate.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

/// Points that a GPU computes in the time of a step's launches: 91 us at 0.18 ns a point (docs/performance.md).
constexpr double least_of_gpu = 5e5;

} // namespace

template<class Exec>
WorkBalance<Exec>::WorkBalance(decomp::Decomposition<Exec>& decomposition, const scene::Balance& options)
    : balance_(decomposition,
               decomp::BalanceRule(options.threshold, options.least_load.value_or(is_gpu<Exec> ? least_of_gpu : 0)))
{
}

template<class Exec>
void WorkBalance<Exec>::note(std::int64_t version, double load, std::int64_t points_moved)
{
    noted_ = version;
    balance_.note(load, points_moved);
}

template<class Exec>
void WorkBalance<Exec>::transfer(StateFile& file)
{
    auto       state       = balance_.state();
    const auto ranks       = static_cast<std::size_t>(file.communicator().size());
    const auto none_or_all = [ranks](const std::vector<double>& loads)
    { return loads.empty() ? accept::Verdict{} : accept::rows(ranks)(loads); };
    file.common("ranks/loads", state.row.loads, accept::all(none_or_all, accept::not_negative()));
    file.numbers("ranks/balance", state.row.imbalance, state.row.repartitions, state.row.points_moved,
                 state.partitioned, state.not_before, steps_, noted_);
    if (file.loads()) { balance_.resume(std::move(state)); }
}

#define TREAD_INSTANTIATE(Exec) template class WorkBalance<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
