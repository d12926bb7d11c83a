#include "solver/simulation.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

/// Bodies in the order that Simulation::step uses them in: contact wants places of points and bodies.
template<class Exec, class Real>
void Simulation<Exec, Real>::transfer(StateFile& file)
{
    if (sand_) { sand_->transfer(file); }
    if (rigid_) { rigid_->transfer(file); }
    if (coupling_) { coupling_->transfer(file, rigid_->view()); }
    file.doubles("simulation/pace", pace_);
    file.numbers("simulation/steps", unbalanced_, damping_, last_.dt, last_.substeps, last_time_, measure_every_);
    file.doubles("simulation/ledger", *ledger_);
    if (guard_) { guard_->transfer(file); }
}

template void Simulation<Cpu, float>::transfer(StateFile&);
template void Simulation<Cpu, double>::transfer(StateFile&);
#ifdef TREAD_WITH_CUDA
template void Simulation<Gpu, float>::transfer(StateFile&);
template void Simulation<Gpu, double>::transfer(StateFile&);
#endif

} // namespace tread::solver
