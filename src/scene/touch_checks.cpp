#include <array>
#include <set>
#include <string>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/contacts.hpp"
#include "scene/keys.hpp"
#include "scene/phase_settings.hpp"

// Which pairs of families may be told not to touch, and what that excludes.
namespace tread::scene
{
namespace
{

/// Sand meets sand and walls on the grid: only pairs with rocks or bodies are contacts that can be left out.
void require_rigid_family(const Scene& scene, const std::array<std::string, 2>& pair, const TableAt& at,
                          const std::string& key, Checker& checker)
{
    const std::set<std::string> rigid = rigid_families(scene);
    if (rigid.count(pair[0]) + rigid.count(pair[1]) > 0) { return; }
    const bool wall = pair[0] == wall_family || pair[1] == wall_family;
    checker.report(at, key,
                   fmt::format("touch = false of [\"{}\", \"{}\"]: {}", pair[0], pair[1],
                               wall ? "no rock or body is of this family, and sand always meets the walls"
                                    : "no rock or body is of these families, and points of sand always meet"),
                   "a pair with a family of rocks or bodies");
}

/// Rocks can replace only sand that they touch.
void require_sand_that_is_touched(const Scene& scene, std::size_t index, Checker& checker)
{
    const Rocks& rocks = scene.rocks[index];
    if (!rocks.from.empty() || !takes_sand(rocks.placement)) { return; }
    const std::string          rock     = family_of(scene, rocks.material);
    const std::vector<Contact> contacts = contacts_in(scene, 0);
    for (const Terrain& terrain : scene.terrain)
    {
        const std::string sand = family_of(scene, terrain.material);
        if (contact_of(contacts, rock, sand).touch) { continue; }
        checker.report({"rocks", index}, "placement",
                       fmt::format("the rocks stand in place of sand, but [\"{}\", \"{}\"] do not touch in the first "
                                   "phase",
                                   rock, sand),
                       "\"rain\" | \"grid\", or touch = true in the first phase");
        return;
    }
}

} // namespace

void validate_touch(const Scene& scene, Checker& checker)
{
    for (std::size_t i = 0; i < scene.contacts.size(); ++i)
    {
        const Contact& contact = scene.contacts[i];
        if (contact.touch || !checker.sound({"contact", i}, {"between"})) { continue; }
        require_rigid_family(scene, contact.between, {"contact", i}, "touch", checker);
    }
    for (std::size_t i = 0; i < scene.phases.size(); ++i)
    {
        if (!checker.sound({"phase", i}, {"contacts"})) { continue; }
        for (const ContactSetting& setting : scene.phases[i].contacts)
        {
            if (setting.touch.value_or(true)) { continue; }
            require_rigid_family(scene, setting.between, {"phase", i}, "contacts", checker);
        }
    }
    for (std::size_t i = 0; i < scene.rocks.size(); ++i) { require_sand_that_is_touched(scene, i, checker); }
}

} // namespace tread::scene
