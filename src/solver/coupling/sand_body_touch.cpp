#include <algorithm>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "solver/coupling/sand_body_coupling.hpp"

// Pairs of sand and bodies that begin or cease to touch at the border of two phases.
namespace tread::solver
{

/// Number of each candidate's body in the scene.
template<class Exec, class Real>
std::vector<std::int32_t> SandBodyCoupling<Exec, Real>::touched_bodies() const
{
    std::vector<std::int32_t>       bodies = contact_.candidates.body.to_host();
    const std::vector<std::int32_t> number = contact_.number.to_host();
    if (number.empty()) { return bodies; }
    for (std::int32_t& body : bodies) { body = number[static_cast<std::size_t>(body)]; }
    return bodies;
}

template<class Exec, class Real>
void SandBodyCoupling<Exec, Real>::add_contact_energies(const BodyMaterials& material, std::size_t sides,
                                                        std::vector<double>& energies) const
{
    const auto response = contact_.response.to_host();
    const auto body = touched_bodies(), touched = contact_.candidates.touched.to_host(),
               sand = contact_.material.to_host();
    const auto add  = [&](std::int32_t of_sand, std::int32_t of_body, double energy)
    {
        const auto low = std::min(of_sand, of_body), high = std::max(of_sand, of_body);
        energies[static_cast<std::size_t>(low) * sides + static_cast<std::size_t>(high)] += energy;
    };
    for (std::size_t c = 0; c < response.size(); ++c)
    {
        add(sand[static_cast<std::size_t>(touched[c])], material[body[c]], response[c].energy);
    }
    const auto key            = asleep_.key.to_host();
    const auto asleep         = asleep_.response.to_host();
    const auto asleep_in_sand = asleep_.material.to_host();
    for (std::size_t i = 0; i < key.size(); ++i)
    {
        add(asleep_in_sand[i], material[contact::body_of(key[i])], asleep[i].energy);
    }
}

/// Evaluates the contacts without letting time pass: what friction loses by it counts with the next substep.
template<class Exec, class Real>
NewTouch SandBodyCoupling<Exec, Real>::own_new_touch(const dem::BodiesView& bodies, const BodyMaterials& material,
                                                     const TouchChange& change)
{
    NewTouch found;
    if (!any_near()) { return found; }
    contact::substep(exec_, contact_, bodies, law_, 0);
    const auto response = contact_.response.to_host();
    const auto body = touched_bodies(), touched = contact_.candidates.touched.to_host(),
               sand   = contact_.material.to_host();
    const auto radius = contact_.radius.to_host();
    for (std::size_t c = 0; c < response.size(); ++c)
    {
        const auto   point = static_cast<std::size_t>(touched[c]);
        const double most  = deepest_new_touch * radius[point];
        if (response[c].overlap <= most) { continue; }
        if (!change.begins(sand[point], material[body[c]])) { continue; }
        found = together(found, {1, response[c].overlap, most, body[c]});
    }
    return found;
}

template<class Exec, class Real>
NewTouch SandBodyCoupling<Exec, Real>::new_touch(const dem::BodiesView& bodies, const BodyMaterials& material,
                                                 const TouchChange& change)
{
    const NewTouch own = own_new_touch(bodies, material, change);
    if (communicator_ == nullptr) { return own; }
    NewTouch all;
    for (const auto& of_rank : decomp::gather_values<NewTouch>(*communicator_, {own}))
    {
        all = together(all, of_rank.front());
    }
    return all;
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void     SandBodyCoupling<Exec, Real>::add_contact_energies(const BodyMaterials&, std::size_t,            \
                                                                         std::vector<double>&) const;                  \
    template NewTouch SandBodyCoupling<Exec, Real>::new_touch(const dem::BodiesView&, const BodyMaterials&,            \
                                                              const TouchChange&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
