#pragma once

#include <vector>

#include "kernels/contact/point_contact.hpp"
#include "kernels/dem/templates.hpp"
#include "kernels/mpm/laws/material_parameters.hpp"
#include "scene/scene.hpp"
#include "world/world.hpp"

namespace tread::world
{

/// Law parameters of all materials of the scene, in its order.
template<class Real>
std::vector<mpm::MaterialParameters<Real>> law_parameters(const scene::Scene& scene);

/// Contact properties of every pair of materials in a phase; the last row and column is the domain's wall.
std::vector<dem::PairProperties> pair_properties(const scene::Scene& scene, std::size_t phase);

/// Friction angle of a granular material at its initial density, under pressures of up to 150 kPa, degrees: that of the
/// scene, or of the model "bolton" the angle that follows from the density.
double initial_friction_angle_deg(const scene::Material& material);

/// Smallest horizontal stress of a granular material under the vertical stress `vertical`; Pa, compression positive:
/// triaxial compression at the yield limit.
double active_stress(const scene::Material& material, double vertical);

/// Speed of compression waves sqrt((lambda + 2 mu) / rho), m/s.
double compression_wave_speed(const scene::Material& material);

/// Rate at which the points' velocities relax towards the grid's, 1/s: the scene's pic_rate, or 0.2 c_p/h for granular
/// and 0.04 c_p/h for elastic materials; the largest over the materials of `points`, since different rates lose
/// momentum where materials share nodes. Infinite for APIC.
double pic_rate(const scene::Scene& scene, const Sand& sand);

/// PIC share of a step of dt (s) at that rate: between 0 and 1, with the same decay per unit time at any small dt.
double pic_share(double rate, double dt);

/// Convert scene options to those of the kernels.
contact::RadiusRule  radius_rule(scene::PointRadius rule);
contact::PointMotion point_motion(scene::PointMotion motion);
double               hertz_factor(scene::HertzFactor factor);

/// Damping ratio zeta of the stiffness-proportional law that gives restitution e when attraction is cut off:
/// e = exp[-(zeta/W)(pi - atan2(2 zeta W, 1 - 2 zeta^2))], W = sqrt(1 - zeta^2) (docs/theory.md#restitution).
double damping_ratio(double restitution);

} // namespace tread::world
