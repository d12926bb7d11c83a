#pragma once

#include "scene/scene.hpp"

// What phases set until another one sets it.
namespace tread::scene
{

/// Gravity in a phase, m/s2: that of the last phase up to it that names one, else the domain's.
Vector3 gravity_in(const Scene& scene, std::size_t phase);

/// Largest magnitude of gravity in any phase, m/s2.
double largest_gravity(const Scene& scene);

/// Largest factor on the inertia of rocks in a phase: that of the last phase up to it that names one, else that of
/// [time].
double mass_scaling_in(const Scene& scene, std::size_t phase);

/// Whether the inertia of rocks may be scaled up in any phase.
bool scales_inertia(const Scene& scene);

/// The scene's contacts with the settings of all phases up to `phase`, for contact_of: the newest of a pair comes
/// first.
std::vector<Contact> contacts_in(const Scene& scene, std::size_t phase);

/// Whether a phase sets which pairs touch.
bool changes_touch(const Scene& scene);

} // namespace tread::scene
