#include "world/touch_table.hpp"

#include "scene/contacts.hpp"
#include "scene/keys.hpp"
#include "scene/phase_settings.hpp"

namespace tread::world
{

TouchTable touch_table(const scene::Scene& scene, std::size_t phase)
{
    const std::vector<scene::Contact> contacts = scene::contacts_in(scene, phase);
    std::vector<std::string>          families;
    for (const scene::Material& material : scene.materials) { families.push_back(material.family); }
    families.emplace_back(scene::wall_family);
    TouchTable table{families.size(), {}};
    for (const std::string& a : families)
    {
        for (const std::string& b : families)
        {
            table.touch.push_back(scene::contact_of(contacts, a, b).touch ? 1 : 0);
        }
    }
    return table;
}

} // namespace tread::world
