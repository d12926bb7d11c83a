#include "scene/phase_settings.hpp"

#include <algorithm>
#include <cmath>

#include "scene/contacts.hpp"

namespace tread::scene
{
namespace
{

/// The setting of the last phase up to `phase` that has one; `before` if none has.
template<class Value>
Value setting_in(const Scene& scene, std::size_t phase, std::optional<Value> Phase::*setting, const Value& before)
{
    for (std::size_t p = std::min(phase + 1, scene.phases.size()); p > 0; --p)
    {
        if (const auto& found = scene.phases[p - 1].*setting) { return *found; }
    }
    return before;
}

} // namespace

Vector3 gravity_in(const Scene& scene, std::size_t phase)
{
    return setting_in(scene, phase, &Phase::gravity, scene.domain.gravity);
}

double largest_gravity(const Scene& scene)
{
    const auto size    = [](const Vector3& g) { return std::hypot(g[0], g[1], g[2]); };
    double     largest = size(scene.domain.gravity);
    for (const Phase& phase : scene.phases)
    {
        if (phase.gravity) { largest = std::max(largest, size(*phase.gravity)); }
    }
    return largest;
}

double mass_scaling_in(const Scene& scene, std::size_t phase)
{
    return setting_in(scene, phase, &Phase::mass_scaling, scene.time.mass_scaling);
}

bool scales_inertia(const Scene& scene)
{
    const auto scales = [](const Phase& phase) { return phase.mass_scaling.value_or(1) > 1; };
    return mass_scaling_in(scene, 0) > 1 || std::any_of(scene.phases.begin(), scene.phases.end(), scales);
}

std::vector<Contact> contacts_in(const Scene& scene, std::size_t phase)
{
    std::vector<Contact> contacts = scene.contacts;
    for (std::size_t p = 0; p < std::min(phase + 1, scene.phases.size()); ++p)
    {
        for (const ContactSetting& setting : scene.phases[p].contacts)
        {
            Contact changed     = contact_of(contacts, setting.between[0], setting.between[1]);
            changed.friction    = setting.friction.value_or(changed.friction);
            changed.restitution = setting.restitution.value_or(changed.restitution);
            changed.touch       = setting.touch.value_or(changed.touch);
            contacts.insert(contacts.begin(), changed);
        }
    }
    return contacts;
}

bool changes_touch(const Scene& scene)
{
    const auto touch = [](const ContactSetting& setting) { return setting.touch.has_value(); };
    return std::any_of(scene.phases.begin(), scene.phases.end(),
                       [&](const Phase& phase)
                       { return std::any_of(phase.contacts.begin(), phase.contacts.end(), touch); });
}

} // namespace tread::scene
