#include <utility>

#include "backend/instantiate.hpp"
#include "solver/simulation.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

constexpr double largest_speed = 1e7; ///< m/s: steps with a larger one would not end

} // namespace

/// Bodies come in the order that Simulation::step uses: contact needs the positions of points and bodies.
template<class Exec, class Real>
void Simulation<Exec, Real>::transfer(StateFile& file)
{
    if (balance_ && file.exact()) { transfer_balance(file); }
    if (sand_) { sand_->transfer(file, world_.points); }
    if (rigid_) { rigid_->transfer(file); }
    if (coupling_)
    {
        coupling_->transfer(
            file, rigid_->view(),
            {world_.bodies.size(), static_cast<std::size_t>(sand_->view().count), world_.points.size()});
    }
    file.numbers("simulation/pace", accept::number(pace_.largest_speed, 0, largest_speed),
                 accept::number(pace_.stiffest_point, 0, accept::largest),
                 accept::number(pace_.shortest_contact, 0, accept::largest), pace_.overlap);
    file.doubles("simulation/extremes", extremes_);
    file.numbers("simulation/steps", unbalanced_, damping_, accept::number(last_.dt, 0, accept::largest),
                 last_.substeps, last_time_, accept::number(measure_every_, 1, most_unmeasured));
    file.doubles("simulation/ledger", *ledger_);
    if (guard_) { guard_->transfer(file); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::transfer_balance(StateFile& file)
{
    auto       state       = balance_->state();
    const auto ranks       = static_cast<std::size_t>(file.communicator().size());
    const auto none_or_all = [ranks](const std::vector<double>& loads)
    { return loads.empty() ? accept::Verdict{} : accept::rows(ranks)(loads); };
    file.common("ranks/loads", state.row.loads, accept::all(none_or_all, accept::not_negative()));
    file.numbers("ranks/balance", state.row.imbalance, state.row.repartitions, state.row.points_moved,
                 state.partitioned, state.not_before, steps_, balanced_version_);
    if (file.loads()) { balance_->resume(std::move(state)); }
}

#define TREAD_INSTANTIATE(Exec, Real) template void Simulation<Exec, Real>::transfer(StateFile&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
