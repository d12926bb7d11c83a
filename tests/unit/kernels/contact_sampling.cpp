#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "contact_scene.hpp"
#include "kernels/contact/samples_kern.hpp"

// Nine samples against the whole contact patch of a point, and around closed paths.
namespace tread::test
{
namespace contact_sampling_test
{

const double radius = contact::point_radius(SceneNumbers{}.volume, contact::RadiusRule::sphere);

/// A body given by its exact distance field, at the origin.
struct Exact
{
    std::function<dem::SdfSample(const Vec3<double>&)> sdf;
    double                                             equivalent_radius;
};

Exact exact_ball(double size)
{
    return {[=](const Vec3<double>& x) { return dem::SdfSample{x.norm() - size, x.normalized()}; }, size};
}

Exact exact_cube(double half, const Quat& turned)
{
    return {[=](const Vec3<double>& x)
            {
                const Vec3<double> local = turned.conjugate() * x;
                const Vec3<double> q     = local.cwiseAbs() - Vec3<double>::Constant(half);
                Vec3<double>       slope = q.cwiseMax(0.0);
                if (!(slope.norm() > 0))
                {
                    int face = 0;
                    q.maxCoeff(&face);
                    slope[face] = 1;
                }
                slope = slope.normalized().cwiseProduct(local.cwiseSign());
                return dem::SdfSample{q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0), turned * slope};
            },
            1.24 * half};
}

contact::PairConstants frictionless(const Exact& body)
{
    return {1e6, 3e5, 0, 1, radius, contact::effective_radius(radius, body.equivalent_radius)};
}

/// Force and energy of a point at x, by nine samples.
contact::Response nine(const Exact& body, const Vec3<double>& x)
{
    std::array<contact::Tangential, 9> none;
    none.fill(contact::no_tangential());
    const auto sdf = [&](const Vec3<double>& offset) { return body.sdf(x + offset); };
    return contact::sampled_response(frictionless(body), x, Vec3<double>::Zero(), Vec3<double>::Zero(), sdf, 1.0,
                                     none.data(), 1e-5);
}

using Offsets = std::vector<Vec3<double>>;

Offsets nine_offsets(const Vec3<double>& x)
{
    Offsets offsets;
    for (int s = 0; s < 9; ++s)
    {
        offsets.push_back(contact::patch_offset(contact::patch_axes(x.normalized()), s, radius));
    }
    return offsets;
}

/// Offsets over the whole patch, in pieces of equal area.
Offsets patch_offsets(const Vec3<double>& x)
{
    const auto    axes  = contact::patch_axes(x.normalized());
    constexpr int rings = 40, spokes = 160;
    Offsets       offsets;
    for (int i = 0; i < rings * spokes; ++i)
    {
        const double ring  = contact::patch_radius * radius * std::sqrt((i / spokes + 0.5) / rings);
        const double angle = 2 * 3.14159265358979323846 * (i % spokes) / spokes;
        offsets.push_back(ring * (std::cos(angle) * axes.first + std::sin(angle) * axes.second));
    }
    return offsets;
}

struct ForceAndCouple
{
    Vec3<double> force;  ///< N, on the point
    Vec3<double> couple; ///< N m, of the samples' mean forces about the point
};

ForceAndCouple by_offsets(const Exact& body, const Vec3<double>& x, const Offsets& offsets)
{
    ForceAndCouple sum{Vec3<double>::Zero(), Vec3<double>::Zero()};
    for (const Vec3<double>& offset : offsets)
    {
        const auto at   = body.sdf(x + offset);
        auto       none = contact::no_tangential();
        const auto one  = contact::point_body_response(frictionless(body),
                                                       {at.distance, at.gradient, Vec3<double>::Zero()}, none, 1e-5);
        sum.force += one.force / static_cast<double>(offsets.size());
        sum.couple += offset.cross(one.force) / static_cast<double>(offsets.size());
    }
    sum.force += sum.couple.cross(x.normalized()) / x.norm();
    return sum;
}

TEST(ContactSampling, NineComeCloserThanOneToTheWholePatch)
{
    // Ball of the point's size, d = 0.4 r deep. In u = (rho / rim)^2 the force across the patch is f0 (1 - 1.13 u +
    // 0.43 u^2 - ...): the mean of u is exact, that of u^2 is 8/9 (3/4)^4 instead of 1/3. The error is -3.9 % of the
    // mean.
    const Exact        ball  = exact_ball(radius);
    const Vec3<double> x     = 1.6 * radius * Vec3<double>(0.48, 0.6, 0.64);
    const double       whole = by_offsets(ball, x, patch_offsets(x)).force.norm(), samples = nine(ball, x).force.norm(),
                 single = by_offsets(ball, x, {Vec3<double>::Zero()}).force.norm();
    std::printf("[ measured ] ball: force over that of the patch %.4f, expected 1, tolerance 0.04 (fourth moment); one "
                "sample %.3f\n",
                samples / whole, single / whole);
    EXPECT_NEAR(samples, whole, 0.04 * whole);

    // Past the edge of a cube: the patch leaves the face gradually. Three rows are off by at most half a row, a sixth
    // of the force on the face; the torque about the cube's centre by that times the lever arm.
    const Exact  cube  = exact_cube(1.5 * radius, Quat::Identity());
    const double face  = by_offsets(cube, {0, 0, 2.2 * radius}, {Vec3<double>::Zero()}).force.norm();
    double       error = 0, single_error = 0, torque_error = 0, single_torque = 0;
    for (int i = 0; i <= 40; ++i)
    {
        const Vec3<double> at(0.05 * i * radius, 0.013 * i * radius, 2.2 * radius);
        const Vec3<double> wanted = by_offsets(cube, at, patch_offsets(at)).force, found = nine(cube, at).force,
                           alone = by_offsets(cube, at, {Vec3<double>::Zero()}).force;
        error                    = std::max(error, (found - wanted).norm() / face);
        single_error             = std::max(single_error, (alone - wanted).norm() / face);
        torque_error             = std::max(torque_error, at.cross(found - wanted).norm() / at.norm() / face);
        single_torque            = std::max(single_torque, at.cross(alone - wanted).norm() / at.norm() / face);
    }
    std::printf("[ measured ] edge of a cube: largest error over the force on the face %.4f, over that times the arm "
                "%.4f, expected 0, tolerance 0.167 (half a column); one sample %.3f, %.3f\n",
                error, torque_error, single_error, single_torque);
    EXPECT_LE(error, 1.0 / 6);
    EXPECT_LE(torque_error, 1.0 / 6);
    EXPECT_LT(error, single_error);
}

/// Around a closed path of the point's position and the body's orientation, over faces, edges and a corner of a cube of
/// the point's size, force and torque do no work except that of the neglected part: the samples' couple about the line
/// to the body's centre, on the point's rotation about it relative to the body.
TEST(ContactSampling, NoWorkAroundALoopButWhatIsLeftOut)
{
    const int          steps = 40000;
    const double       turn  = 2 * 3.14159265358979323846;
    const Vec3<double> axis  = Vec3<double>(1, 2, 3).normalized();
    double             work = 0, left_out = 0, exchanged = 0, highest = 0, last_swing = 0;
    Vec3<double> last_at = Vec3<double>::Zero(), last_force = last_at, last_torque = last_at, last_first = last_at;
    for (int i = 0; i <= steps; ++i)
    {
        const double       angle = turn * i / steps, swing = 0.5 * std::sin(2 * angle + 1);
        const Vec3<double> at =
            radius * Vec3<double>(1.4 * std::cos(angle), 0.9 * std::cos(angle + 0.4), 1.9 + 0.6 * std::sin(angle));
        const Exact        cube   = exact_cube(radius, Quat(Eigen::AngleAxisd(swing, axis)));
        const auto         found  = nine(cube, at);
        const Vec3<double> torque = -at.cross(found.force); // on the body
        const Vec3<double> line   = at.normalized();
        const auto         axes   = contact::patch_axes(line);
        if (i > 0)
        {
            const double increment = 0.5 * (found.force + last_force).dot(at - last_at) +
                                     0.5 * (torque + last_torque).dot(axis) * (swing - last_swing);
            work += increment;
            exchanged += std::abs(increment);
            left_out += by_offsets(cube, at, nine_offsets(at)).couple.dot(line) *
                        (axes.second.dot(axes.first - last_first) - line.dot(axis) * (swing - last_swing));
        }
        highest     = std::max(highest, found.energy);
        last_force  = found.force;
        last_torque = torque;
        last_at     = at;
        last_first  = axes.first;
        last_swing  = swing;
    }
    std::printf(
        "[ measured ] work around the loop %.2e of the greatest energy (exchanged %.2f), expected %.2e, tolerance "
        "1e-3 of the design\n",
        work / highest, exchanged / highest, -left_out / highest);
    EXPECT_GT(exchanged, highest);
    EXPECT_NEAR(work, -left_out, 1e-3 * highest);
    EXPECT_LE(std::abs(work), 0.05 * highest);
}

} // namespace contact_sampling_test
} // namespace tread::test
