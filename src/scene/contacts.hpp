#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tread::scene
{

/// Contact family of a material; its own name if there is none of that name.
std::string family_of(const Scene& scene, const std::string& material);

/// Families of rocks and bodies.
std::set<std::string> rigid_families(const Scene& scene);

/// Friction and restitution of two families, in either order. Pairs that are not among `contacts` have friction 0.3
/// (0.5 with "wall") and restitution 0.5, and touch.
Contact contact_of(const std::vector<Contact>& contacts, const std::string& family_a, const std::string& family_b);

/// Adds default contacts for every pair that can meet (rocks and bodies with each other, with terrain, with walls).
void complete_contacts(Scene& scene);

} // namespace tread::scene
