#include "scene/phase_settings.hpp"

#include <algorithm>
#include <cmath>

#include "scene/contacts.hpp"

namespace tread::scene
{
namespace
{

/// The contact of that pair; added to `contacts` with its defaults if it is not there.
Contact& contact_between(std::vector<Contact>& contacts, const std::array<std::string, 2>& pair)
{
    const auto found = std::find_if(contacts.begin(), contacts.end(),
                                    [&](const Contact& contact)
                                    { return std::is_permutation(pair.begin(), pair.end(), contact.between.begin()); });
    if (found != contacts.end()) { return *found; }
    return contacts.emplace_back(contact_of({}, pair[0], pair[1]));
}

} // namespace

Vector3 gravity_in(const Scene& scene, std::size_t phase)
{
    for (std::size_t p = std::min(phase + 1, scene.phases.size()); p > 0; --p)
    {
        if (const auto& gravity = scene.phases[p - 1].gravity) { return *gravity; }
    }
    return scene.domain.gravity;
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

std::vector<Contact> contacts_in(const Scene& scene, std::size_t phase)
{
    std::vector<Contact> contacts = scene.contacts;
    for (std::size_t p = 0; p < std::min(phase + 1, scene.phases.size()); ++p)
    {
        for (const ContactSetting& setting : scene.phases[p].contacts)
        {
            Contact& contact    = contact_between(contacts, setting.between);
            contact.friction    = setting.friction.value_or(contact.friction);
            contact.restitution = setting.restitution.value_or(contact.restitution);
        }
    }
    return contacts;
}

} // namespace tread::scene
