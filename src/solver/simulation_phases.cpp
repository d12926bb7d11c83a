#include <algorithm>
#include <utility>

#include "backend/instantiate.hpp"
#include "decomp/combine.hpp"
#include "scene/phase_settings.hpp"
#include "solver/ledger/contact_guards.hpp"
#include "solver/simulation.hpp"
#include "solver/state_file.hpp"

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
        if (rigid_)
        {
            if (rigid_->asleep() > 0 && !measured()) { measure(); } // rocks wake: their pairs must be listed at once
            set_contacts(phase);
            if (rigid_->set_mass_scaling(phase) && !measured()) { measure(); } // which chooses the substeps anew
        }
        phase_ = static_cast<std::int64_t>(phase);
    }
    if (rigid_) { rigid_->begin_phase(phase); }
}

/// Lists are made for the next step only: the number of steps was chosen for less acceleration.
template<class Exec, class Real>
void Simulation<Exec, Real>::expect_acceleration(double acceleration)
{
    const double more = rigid_->expect_acceleration(acceleration);
    if (more <= 0) { return; }
    limits_.gravity += more;
    measuring_.every = 1;
}

template<class Exec, class Real>
void Simulation<Exec, Real>::set_gravity(const Vec3<double>& gravity)
{
    gravity_ = gravity;
    if (sand_) { sand_->set_gravity(gravity); }
    if (rigid_) { rigid_->set_gravity(gravity); }
}

/// Pairs that cease to touch leave the lists at once, and their springs let go. Pairs that begin to touch enter them in
/// the next step.
template<class Exec, class Real>
void Simulation<Exec, Real>::set_contacts(std::size_t phase)
{
    const auto  before = static_cast<std::size_t>(std::max<std::int64_t>(phase_, 0));
    TouchChange change{world::touch_table(scene_, before), world::touch_table(scene_, phase)};
    if (change.any())
    {
        if (!measured()) { measure(); }
        const ContactEnergies energies = contact_energies();
        ledger_->release(released(change, energies.bodies), released(change, energies.sand));
        rigid_->forget_list();
        if (coupling_) { coupling_->forget_candidates(); }
        if (change.any_begins()) { touch_change_ = std::move(change); }
    }
    rigid_->set_contacts(phase);
}

template<class Exec, class Real>
ContactEnergies Simulation<Exec, Real>::contact_energies() const
{
    if (loaded_energies_) { return *loaded_energies_; }
    const std::size_t   sides = scene_.materials.size() + 1;
    std::vector<double> zero(sides * sides, 0);
    ContactEnergies     energies{zero, zero};
    rigid_->add_contact_energies(sides, energies.bodies);
    if (coupling_) { coupling_->add_contact_energies(rigid_->materials(), sides, energies.sand); }
    if (decomposition_ == nullptr) { return energies; }
    for (std::vector<double>* of_pairs : {&energies.bodies, &energies.sand})
    {
        decomp::combine(decomposition_->communicator, of_pairs->data(), static_cast<int>(sides * sides), 0);
    }
    return energies;
}

template<class Exec, class Real>
void Simulation<Exec, Real>::require_apart(double time)
{
    if (!touch_change_) { return; }
    const TouchChange change = *std::exchange(touch_change_, std::nullopt);
    const auto        phase  = static_cast<std::size_t>(phase_);
    if (plan_.body_contact) { rigid_->require_apart(change, phase, time); }
    if (!coupling_) { return; }
    const NewTouch found = coupling_->new_touch(rigid_->view(), rigid_->materials(), change);
    if (found.points == 0) { return; }
    refuse_new_touch(found, rigid_->name(found.body), scene_.phases[phase].name, time);
}

/// Pairs that touch in all phases or in none need nothing: the phase that begins next sets all other properties.
template<class Exec, class Real>
void Simulation<Exec, Real>::transfer_contacts(StateFile& file)
{
    if (!rigid_ || !scene::changes_touch(scene_)) { return; }
    const std::size_t sides    = scene_.materials.size() + 1;
    const auto        accepted = accept::all(accept::rows(sides * sides), accept::finite());
    ContactEnergies   energies;
    if (!file.loads()) { energies = contact_energies(); }
    file.numbers("contacts/phase", accept::number(phase_, -1, static_cast<double>(scene_.phases.size()) - 1));
    file.common("contacts/energy_of_bodies", energies.bodies, accepted);
    file.common("contacts/energy_of_sand", energies.sand, accepted);
    if (!file.loads()) { return; }
    loaded_energies_ = std::move(energies);
    if (phase_ >= 0) { rigid_->set_contacts(static_cast<std::size_t>(phase_)); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void Simulation<Exec, Real>::begin_phase(std::size_t);                                                    \
    template void Simulation<Exec, Real>::expect_acceleration(double);                                                 \
    template void Simulation<Exec, Real>::set_gravity(const Vec3<double>&);                                            \
    template void Simulation<Exec, Real>::require_apart(double);                                                       \
    template void Simulation<Exec, Real>::transfer_contacts(StateFile&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
