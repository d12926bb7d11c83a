#include "scene/contacts.hpp"

#include <algorithm>

#include "scene/keys.hpp"

namespace tread::scene
{
namespace
{

constexpr double wall_friction = 0.5;

bool is_between(const Contact& contact, const std::string& a, const std::string& b)
{
    const auto& pair = contact.between;
    return (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
}

const Contact* find_contact(const std::vector<Contact>& contacts, const std::string& a, const std::string& b)
{
    const auto found = std::find_if(contacts.begin(), contacts.end(),
                                    [&](const Contact& contact) { return is_between(contact, a, b); });
    return found == contacts.end() ? nullptr : &*found;
}

} // namespace

std::string family_of(const Scene& scene, const std::string& material)
{
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const Material& candidate) { return candidate.name == material; });
    return found == scene.materials.end() ? material : found->family;
}

Contact contact_of(const std::vector<Contact>& contacts, const std::string& family_a, const std::string& family_b)
{
    if (const Contact* given = find_contact(contacts, family_a, family_b)) { return *given; }
    Contact contact{{family_a, family_b}};
    if (family_a == wall_family || family_b == wall_family) { contact.friction = wall_friction; }
    return contact;
}

std::set<std::string> rigid_families(const Scene& scene)
{
    std::set<std::string> rigid;
    for (const auto& rocks : scene.rocks) { rigid.insert(family_of(scene, rocks.material)); }
    for (const auto& body : scene.bodies) { rigid.insert(family_of(scene, body.material)); }
    return rigid;
}

void complete_contacts(Scene& scene)
{
    const std::set<std::string> rigid    = rigid_families(scene);
    std::set<std::string>       partners = rigid;
    for (const auto& terrain : scene.terrain) { partners.insert(family_of(scene, terrain.material)); }
    partners.insert(std::string(wall_family));
    for (const auto& a : rigid)
    {
        for (const auto& b : partners)
        {
            if (find_contact(scene.contacts, a, b) == nullptr)
            {
                scene.contacts.push_back(contact_of(scene.contacts, a, b));
            }
        }
    }
}

} // namespace tread::scene
