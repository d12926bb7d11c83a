#include <utility>

#include "solver/simulation.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

/// Bodies in the order that Simulation::step uses them in: contact wants places of points and bodies.
template<class Exec, class Real>
void Simulation<Exec, Real>::transfer(StateFile& file)
{
    if (balance_ && file.exact()) { transfer_balance(file); }
    if (sand_) { sand_->transfer(file, world_.points); }
    if (rigid_) { rigid_->transfer(file); }
    if (coupling_) { coupling_->transfer(file, rigid_->view()); }
    file.doubles("simulation/pace", pace_);
    file.doubles("simulation/extremes", extremes_);
    file.numbers("simulation/steps", unbalanced_, damping_, last_.dt, last_.substeps, last_time_, measure_every_);
    file.doubles("simulation/ledger", *ledger_);
    if (guard_) { guard_->transfer(file); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::transfer_balance(StateFile& file)
{
    auto state = balance_->state();
    file.common("ranks/loads", state.row.loads);
    file.numbers("ranks/balance", state.row.imbalance, state.row.repartitions, state.row.points_moved,
                 state.partitioned, state.not_before, steps_, arranged_);
    if (file.loads()) { balance_->resume(std::move(state)); }
}

template void Simulation<Cpu, float>::transfer(StateFile&);
template void Simulation<Cpu, double>::transfer(StateFile&);
#ifdef TREAD_WITH_CUDA
template void Simulation<Gpu, float>::transfer(StateFile&);
template void Simulation<Gpu, double>::transfer(StateFile&);
#endif

} // namespace tread::solver
