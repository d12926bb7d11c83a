#pragma once

#include <cmath>

#include "kernels/contact/point_body_kern.hpp"
#include "kernels/dem/contact/sdf_kern.hpp"

// Nine samples of a point on a body of comparable size (the paper's section 2.4): 3x3 on a patch through the point's
// centre, normal to the line to the body's centre. Each has the point's law and its own history, and a weight of 1/9.
// On an edge, a groove or a tip smaller than the point the force changes gradually, as the overlap of the patch does.
// The patch follows the point around the body but not the body's rotation. All forces act at the point's centre, and
// friction on the body at a sample's distance from it, as for a single sample; the normal forces leave no couple (see
// turning_force).
//
// The patch is a disc with the area of a face of a cube of the point's volume. The 3x3 squares are mapped onto it so
// that eight samples form a ring, which makes the force nearly independent of the ring's orientation. The ring has the
// patch's mean squared distance: it is at 3/4 of the patch radius (4 pi / 3)^(1/3) / sqrt(pi) r_p.
namespace tread::contact
{

constexpr int    patch_samples = 9;
constexpr double patch_radius  = 0.9094;              ///< r_p
constexpr double patch_reach   = 0.75 * patch_radius; ///< r_p, from the point's centre to the ring

/// Whether points take nine samples on an instance of the template: it is smaller than `below` (m, 0 = never).
TREAD_HD bool takes_samples(const dem::TemplateView& shape, double scale, double below)
{
    return shape.equivalent_radius * scale < below;
}

/// Two unit vectors normal to the unit vector `line` and to each other; the grid's x and y if `line` is vertical (T.
/// Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017).
struct PatchAxes
{
    Vec3<double> first;
    Vec3<double> second;
};

TREAD_HD PatchAxes patch_axes(const Vec3<double>& line)
{
    const double x = line[0], y = line[1], z = line[2];
    const double up = std::copysign(1.0, z), a = -1.0 / (up + z), b = x * y * a;
    return {{1.0 + up * x * x * a, up * b, -up * x}, {b, up + y * y * a, -y}};
}

/// Returns the offset of sample 0 ... 8 from the point's centre, m. Sample 4 is the centre.
TREAD_HD Vec3<double> patch_offset(const PatchAxes& axes, int sample, double point_radius)
{
    const int    column = sample % 3 - 1, row = sample / 3 - 1;
    const double step = patch_reach * point_radius * (column != 0 && row != 0 ? 0.70710678118654752440 : 1.0);
    return step * column * axes.first + step * row * axes.second;
}

/// Adds a sample to the combined response: means, except overlap and gradient, which are those of the deepest sample.
TREAD_HD void add_sample(Response& sum, const Response& sample)
{
    constexpr double share = 1.0 / patch_samples;
    sum.force += share * sample.force;
    sum.couple += share * sample.couple;
    sum.stiffness += share * sample.stiffness;
    sum.energy += share * sample.energy;
    sum.dissipated += share * sample.dissipated;
    if (!(sample.overlap > sum.overlap)) { return; }
    sum.overlap         = sample.overlap;
    sum.gradient_length = sample.gradient_length;
}

/// Force on the point that compensates the rotation of the samples. When the point moves around the body, its samples
/// turn about it, against the couple of their normal forces (N m, about the point). The force that does this work, so
/// that force and energy again derive from one potential, is couple x line / arm. With the opposite force at the point,
/// the body gets the torque of the samples.
TREAD_HD Vec3<double> turning_force(const Vec3<double>& couple, const Vec3<double>& line, double arm)
{
    return couple.cross(line) / arm;
}

/// Computes the response of a point at `arm` from the body's centre (m) that moves at `velocity` relative to the body's
/// material there; the body rotates at `spin` (rad/s). sdf(offset) samples the body at an offset from the point; no
/// sample is in contact if the centre is further than `bound` (m). `tangential` is the history of the samples.
template<class Sdf>
TREAD_HD Response sampled_response(const PairConstants& pair, const Vec3<double>& arm, const Vec3<double>& velocity,
                                   const Vec3<double>& spin, const Sdf& sdf, double bound, Tangential* tangential,
                                   double dt)
{
    const double         length = arm.norm();
    const Vec3<double>   line   = length > 0 ? Vec3<double>(arm / length) : Vec3<double>(0.0, 0.0, 1.0);
    const PatchAxes      axes   = patch_axes(line);
    const dem::SdfSample centre = sdf(Vec3<double>(0.0, 0.0, 0.0));
    const bool           far    = centre.distance > bound;

    Response     sum    = no_response();
    Vec3<double> couple = Vec3<double>::Zero();
    for (int s = 0; s < patch_samples; ++s)
    {
        const Vec3<double>   offset = patch_offset(axes, s, pair.point_radius);
        const bool           known  = far || s == patch_samples / 2;
        const dem::SdfSample at     = known ? centre : sdf(offset);
        const Vec3<double>   past   = velocity + spin.cross(stand_off(at.distance, at.gradient));
        const Response       one    = point_body_response(pair, {at.distance, at.gradient, past}, tangential[s], dt);
        couple += 1.0 / patch_samples * offset.cross(one.force - tangential[s].force);
        add_sample(sum, one);
    }
    if (length > 0) { sum.force += turning_force(couple, line, length); }
    return sum;
}

} // namespace tread::contact
