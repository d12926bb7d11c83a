#include "solver/bodies/body_touch.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/errors.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "solver/ranks/over_ranks.hpp"

namespace tread::solver
{
namespace
{

/// Materials of a pair, the smaller index first; that of a wall is the last. `material`: of each row's body.
std::pair<std::size_t, std::size_t> materials_of(const std::vector<std::int32_t>& material, std::size_t wall,
                                                 std::uint64_t key)
{
    const auto a = static_cast<std::size_t>(dem::first_of(key)), b = static_cast<std::size_t>(dem::second_of(key));
    const auto one = static_cast<std::size_t>(material[a]);
    return std::minmax({one, b < material.size() ? static_cast<std::size_t>(material[b]) : wall});
}

/// m, largest overlap of each listed pair at the bodies' present places. The records stay as they are.
template<class Exec>
std::vector<double> present_overlaps(BodyState<Exec>& state)
{
    dem::Pairs<Exec>& pairs   = state.pairs;
    const auto        patch   = pairs.patch.to_host();
    const auto        rolling = pairs.rolling.to_host();
    dem::evaluate_contacts(state.exec, pairs, state.view(), state.tables.law, 0);
    pairs.patch.assign(patch);
    pairs.rolling.assign(rolling);
    return pairs.peak.to_host();
}

/// m, accepted overlap of a pair that begins to touch: a share of the smaller radius; a wall has none. `radius`: of
/// each row's body.
double most_overlap(const std::vector<double>& radius, std::uint64_t key)
{
    const auto a = static_cast<std::size_t>(dem::first_of(key)), b = static_cast<std::size_t>(dem::second_of(key));
    return deepest_new_touch * (b < radius.size() ? std::min(radius[a], radius[b]) : radius[a]);
}

template<class Exec>
[[noreturn]] void refuse(const BodyState<Exec>& state, std::uint64_t key, double overlap, double most,
                         std::size_t phase, double time)
{
    const std::int64_t b    = dem::second_of(key);
    const bool         wall = b >= state.bodies.position.size();
    throw NumericalError(fmt::format("t = {:.6g} s: body {} and {} begin to touch in phase '{}', and overlap by {:.3g} "
                                     "m; accepted: at most {:.3g} m, so that the contact does not throw them apart: "
                                     "move them apart before the phase",
                                     time, state.name(dem::first_of(key)), wall ? "a wall" : "body " + state.name(b),
                                     state.scene.phases[phase].name, overlap, most));
}

} // namespace

template<class Exec>
void add_contact_energies(const BodyState<Exec>& state, std::size_t sides, std::vector<double>& energies)
{
    const std::vector<std::int32_t>  material = state.bodies.material.to_host();
    const std::vector<std::uint64_t> keys     = state.pairs.key.to_host();
    const std::vector<double>        energy   = state.pairs.answers.energy.to_host();
    for (std::size_t p = 0; p < energy.size(); ++p)
    {
        const auto [a, b] = materials_of(material, sides - 1, keys[p]);
        energies[a * sides + b] += energy[p];
    }
    const std::vector<std::uint64_t>    kept     = state.pairs.sleep.pairs.key.to_host();
    const std::vector<dem::HeldContact> contacts = state.pairs.sleep.pairs.contact.to_host();
    for (std::size_t p = 0; p < kept.size(); ++p)
    {
        const auto [a, b] = materials_of(material, sides - 1, kept[p]);
        energies[a * sides + b] += contacts[p].energy;
    }
}

template<class Exec>
void require_apart(BodyState<Exec>& state, const TouchChange& change, std::size_t phase, double time)
{
    const std::vector<std::int32_t>  material = state.bodies.material.to_host();
    const std::vector<double>        radius   = state.radii();
    const std::vector<std::uint64_t> keys     = state.pairs.key.to_host();
    const std::vector<double>        overlaps = present_overlaps(state);
    check_on_ranks(state.communicator(),
                   [&]
                   {
                       for (std::size_t p = 0; p < keys.size(); ++p)
                       {
                           const auto [a, b] = materials_of(material, change.after.wall(), keys[p]);
                           if (!change.begins(a, b)) { continue; }
                           const double most = most_overlap(radius, keys[p]);
                           if (overlaps[p] > most) { refuse(state, keys[p], overlaps[p], most, phase, time); }
                       }
                   });
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void add_contact_energies(const BodyState<Exec>&, std::size_t, std::vector<double>&);                     \
    template void require_apart(BodyState<Exec>&, const TouchChange&, std::size_t, double)
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
