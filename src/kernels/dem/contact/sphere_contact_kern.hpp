#pragma once

#include "kernels/dem/contact/body_contact_kern.hpp"

// Contact of two exact spheres, or of a sphere and a plane: Hertz's law in closed form, the paper's Eq. 14, instead of
// sums over nodes. The friction record and its law are those of every other pair.
namespace tread::dem
{

/// Contact geometry of two surfaces, relative to the centre of a.
struct SphereContact
{
    Vec3<double> normal;  ///< unit, towards a
    double       overlap; ///< m; separated if not positive
    double       depth;   ///< m, from the centre of a to the middle of the overlap
};

/// Contact of two spheres. Radii in m; `arm` = centre of b relative to that of a, m.
TREAD_HD SphereContact contact_of_spheres(double radius_a, double radius_b, const Vec3<double>& arm)
{
    const double       distance = arm.norm();
    const Vec3<double> normal   = distance > 0 ? Vec3<double>(arm / -distance) : Vec3<double>(Vec3<double>::UnitZ());
    const double       overlap  = radius_a + radius_b - distance;
    return {normal, overlap, radius_a - 0.5 * overlap};
}

/// Contact of a sphere and a wall; the wall is rigid, so that the contact acts on its plane.
TREAD_HD SphereContact contact_with_plane(double radius, const PlaneField& wall)
{
    const double overlap = radius + wall.offset;
    return {wall.normal, overlap, radius - overlap};
}

/// Stiffness dF/dd of Hertz's law, N/m: 2 E* a with a = sqrt(R* d).
TREAD_HD double hertz_stiffness(const PairLaw& law, double overlap)
{
    return 2.0 * law.effective_young * std::sqrt(law.effective_radius * overlap);
}

/// Maximum overlap (m) of an impact at `speed` (m/s): k d^2.5 = 5/4 m v^2 with k = 4/3 E* sqrt(R*).
TREAD_HD double hertz_impact_overlap(const PairLaw& law, double speed)
{
    const double k = 4.0 / 3.0 * law.effective_young * std::sqrt(law.effective_radius);
    return law.reduced_mass > 0 ? std::pow(1.25 * law.reduced_mass * speed * speed / k, 0.4) : 0.0;
}

/// Returns the equivalent of the sums over a patch's nodes, concentrated at its centre; the friction record adds the
/// arm of Hertz's pressure itself. With damping 2 zeta sqrt(5/6 m* K) v and no attraction, the contact has the
/// restitution of a linear one with the same zeta (Antypov and Elliott 2011, EPL 94:50004).
TREAD_HD PatchSums sphere_sums(const PairLaw& law, const SphereContact& contact, const RelativeMotion& motion)
{
    const double       stiffness  = hertz_stiffness(law, contact.overlap);
    const double       elastic    = 2.0 / 3.0 * stiffness * contact.overlap;
    const Vec3<double> n          = contact.normal;
    const Vec3<double> place      = -contact.depth * n;
    const double       rate       = -n.dot(motion.at(place));
    const double       relaxation = std::sqrt(5.0 / 6.0) * relaxation_time(law, stiffness);
    const double       damping    = std::fmax(stiffness * relaxation * rate, -elastic);

    PatchSums sums = PatchSums::zero();
    sums.weight    = elastic + damping;
    sums.force     = sums.weight * n;
    sums.first     = sums.weight * place;
    sums.second    = sums.weight * contact.depth * contact.depth *
                  Sym3<double>(n[0] * n[0], n[1] * n[1], n[2] * n[2], n[1] * n[2], n[0] * n[2], n[0] * n[1]);
    sums.energy  = 0.4 * elastic * contact.overlap;
    sums.damping = damping * rate;
    return sums;
}

TREAD_HD NodeSums sums_of_spheres(const PairLaw& law, const SphereContact& contact, const RelativeMotion& motion)
{
    if (!(contact.overlap > 0)) { return no_nodes(); }
    return {{hertz_stiffness(law, contact.overlap), contact.overlap}, sphere_sums(law, contact, motion)};
}

} // namespace tread::dem
