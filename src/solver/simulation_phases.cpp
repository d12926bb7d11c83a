#include "backend/instantiate.hpp"
#include "scene/phase_settings.hpp"
#include "solver/simulation.hpp"

// What a simulation changes from one phase to the next.
namespace tread::solver
{

template<class Exec, class Real>
void Simulation<Exec, Real>::begin_phase(std::size_t phase)
{
    if (static_cast<std::int64_t>(phase) != phase_)
    {
        const Vec3<double> gravity(scene::gravity_in(scene_, phase).data());
        if (gravity != gravity_)
        {
            const Census before = census();
            set_gravity(gravity);
            ledger_->turn_gravity(gravity, before, census());
            wakes_ = sand_ && sand_->may_sleep();
        }
        if (rigid_) { rigid_->set_contacts(phase); }
        phase_ = static_cast<std::int64_t>(phase);
    }
    if (rigid_) { rigid_->begin_phase(phase); }
}

template<class Exec, class Real>
void Simulation<Exec, Real>::set_gravity(const Vec3<double>& gravity)
{
    gravity_ = gravity;
    if (sand_) { sand_->set_gravity(gravity); }
    if (rigid_) { rigid_->set_gravity(gravity); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void Simulation<Exec, Real>::begin_phase(std::size_t);                                                    \
    template void Simulation<Exec, Real>::set_gravity(const Vec3<double>&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
