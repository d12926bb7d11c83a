#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "backend.hpp"
#include "dem_shapes.hpp"
#include "kernels/dem/contact/body_contact.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "kernels/dem/motion/move.hpp"
#include "kernels/dem/motion/sums.hpp"

// A few rigid bodies with analytic shapes and walls, for tests of body-body contact.
namespace tread::test
{

struct Solid
{
    std::int32_t  shape       = 0;
    double        scale       = 1;
    double        mass        = 1;
    Mat3<double>  inertia     = Mat3<double>::Identity();
    Vec3<double>  position    = Vec3<double>::Zero();
    Vec3<double>  velocity    = Vec3<double>::Zero();
    Vec3<double>  spin        = Vec3<double>::Zero(); ///< rad/s
    Quat          orientation = Quat::Identity();
    std::uint32_t locked      = 0;
    std::int32_t  damped      = 0;
};

/// A homogeneous sphere of radius r; its shape is unit_sphere.
inline Solid solid_sphere(double radius, double density, const Vec3<double>& position)
{
    Solid solid;
    solid.scale    = radius;
    solid.mass     = density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    solid.inertia  = Mat3<double>::Identity() * (0.4 * solid.mass * radius * radius);
    solid.position = position;
    return solid;
}

/// E* and G* of equal materials in contact (the paper's Eqs. 8, 10), or of one against a rigid wall.
inline dem::PairProperties properties(double young, double poisson, double sides, double friction, double zeta)
{
    const double shear = young / (2 * (1 + poisson));
    return {young / (1 - poisson * poisson) / sides, shear / (2 - poisson) / sides, friction, zeta};
}

/// Damping ratio zeta for a restitution (docs/verification.md#restitution; beyond 1 the same equation's other branch),
/// by bisection.
inline double damping_ratio(double restitution)
{
    double low = 0, high = 3.9;
    for (int step = 0; step < 60; ++step)
    {
        const double zeta = 0.5 * (low + high), w = std::sqrt(std::abs(1 - zeta * zeta));
        const double e                 = zeta < 1
                                             ? std::exp(-zeta / w * (std::numbers::pi - std::atan2(2 * zeta * w, 1 - 2 * zeta * zeta)))
                                             : std::exp(-2 * zeta / w * std::atanh(w / zeta));
        (e > restitution ? low : high) = zeta;
    }
    return low;
}

/// Properties of the one material; walls are rigid.
struct SolidNumbers
{
    double                  young = 1e7, poisson = 0.3, friction = 0, zeta = 0;
    Vec3<double>            gravity = Vec3<double>::Zero();
    dem::ContactOptions     options = {1.0, 1e-3};
    std::vector<dem::Plane> planes;
};

template<class Exec>
class SolidScene
{
public:
    SolidScene(const Exec& exec, const std::vector<SolidShape>& shapes, const std::vector<Solid>& solids,
               SolidNumbers scene_numbers)
        : numbers(std::move(scene_numbers))
        , bodies(exec)
        , pairs(exec)
        , totals(exec, "test totals")
        , exec_(exec)
        , templates_(exec, "test templates")
        , properties_(exec, "test properties")
        , planes_(exec, "test planes")
    {
        make_shapes(shapes);
        make_bodies(solids);
        const auto own  = properties(numbers.young, numbers.poisson, 2, numbers.friction, numbers.zeta);
        const auto wall = properties(numbers.young, numbers.poisson, 1, numbers.friction, numbers.zeta);
        properties_.assign({own, wall, wall, wall});
        planes_.assign(numbers.planes);
        classify_bodies(exec_, pairs, bodies.view(), templates_.data(), dem::largest_in_grid(bounding_radii()));
    }

    /// m
    std::vector<double> bounding_radii() const
    {
        const auto          shape = bodies.shape.to_host();
        const auto          forms = templates_.to_host();
        std::vector<double> radii = bodies.scale.to_host();
        for (std::size_t b = 0; b < radii.size(); ++b)
        {
            radii[b] *= forms[static_cast<std::size_t>(shape[b])].bounding_radius;
        }
        return radii;
    }

    dem::BodyLaw law() const
    {
        return {templates_.data(), {properties_.data(), 2},
                planes_.data(),    static_cast<std::int32_t>(numbers.planes.size()),
                numbers.options,   rays};
    }

    /// Runs `count` substeps of dt, with pairs rebuilt every `every` of them.
    void run(double dt, int count, int every = 20)
    {
        stage_bodies(exec_, pairs, bodies.view());
        for (int step = 0; step < count; ++step)
        {
            if (substeps_++ % every == 0) { find(dt * every); }
            evaluate_contacts(exec_, pairs, bodies.view(), law(), dt);
            move(dt);
        }
    }

    /// Moves by a substep of dt; contact forces act only if computed before. alpha: local damping.
    void move(double dt, double alpha = 0, const dem::OutsideWrenches& outside = {})
    {
        move_bodies(exec_, step(dt, alpha, outside));
    }

    dem::BodyStep<Exec> step(double dt, double alpha = 0, const dem::OutsideWrenches& outside = {})
    {
        return {pairs, bodies.view(), law(), totals.data(), {nullptr, 0}, {numbers.gravity, alpha, dt, outside}};
    }

    void find(double dt, double substeps = 1)
    {
        find_pairs(exec_, pairs, bodies.view(), law(), dt, substeps, numbers.gravity.norm());
    }

    /// Forces on the bodies at their present positions: a move of zero duration.
    void contact(double dt)
    {
        stage_bodies(exec_, pairs, bodies.view());
        evaluate_contacts(exec_, pairs, bodies.view(), law(), dt);
        move(0);
    }

    dem::BodySums sums() { return sum_bodies(exec_, pairs, bodies.view(), totals, numbers.gravity); }

    SolidNumbers          numbers;
    const dem::RayView*   rays = nullptr; ///< ray data of the shapes, if bodies meet by rays
    dem::Bodies<Exec>     bodies;
    dem::Pairs<Exec>      pairs;
    dem::BodyTotals<Exec> totals;

private:
    void make_shapes(const std::vector<SolidShape>& shapes)
    {
        std::vector<dem::TemplateView> views;
        const auto                     keep = [&](auto& arrays, const auto& values)
        {
            arrays.emplace_back(exec_, "test shape");
            arrays.back().assign(values);
            return arrays.back().data();
        };
        for (const SolidShape& shape : shapes)
        {
            dem::TemplateView view{};
            view.sdf.origin          = shape.origin;
            view.sdf.spacing         = shape.spacing;
            view.sdf.inverse_spacing = 1 / shape.spacing;
            view.sdf.steepest        = shape.steepest;
            std::copy(shape.nodes.begin(), shape.nodes.end(), view.sdf.nodes);
            view.sdf.values     = keep(floats_, shape.values);
            view.sdf.slots      = shape.slots.empty() ? nullptr : keep(integers_, shape.slots);
            view.sdf.corners    = keep(floats_, shape.corners);
            view.sdf.fine_reach = shape.fine_reach;
            std::copy(shape.bricks.begin(), shape.bricks.end(), view.sdf.bricks);
            view.node_count        = static_cast<std::int32_t>(shape.positions.size());
            view.part_count        = static_cast<std::int32_t>(shape.centres.size());
            view.node_positions    = keep(vectors_, shape.positions);
            view.node_areas        = keep(doubles_, shape.areas);
            view.part_centres      = keep(vectors_, shape.centres);
            view.part_radii        = keep(doubles_, shape.radii);
            view.low               = -shape.half;
            view.high              = shape.half;
            view.bounding_radius   = shape.bounding_radius;
            view.equivalent_radius = shape.equivalent_radius;
            view.sphere_radius     = shape.sphere_radius;
            view.concave           = shape.concave;
            views.push_back(view);
        }
        templates_.assign(views);
    }

    void make_bodies(const std::vector<Solid>& solids)
    {
        const auto gather = [&](auto& array, auto member)
        {
            std::vector<std::remove_cvref_t<decltype(solids[0].*member)>> values;
            for (const Solid& solid : solids) { values.push_back(solid.*member); }
            array.assign(values);
        };
        gather(bodies.position, &Solid::position);
        gather(bodies.orientation, &Solid::orientation);
        gather(bodies.velocity, &Solid::velocity);
        gather(bodies.angular_velocity, &Solid::spin);
        gather(bodies.mass, &Solid::mass);
        gather(bodies.scale, &Solid::scale);
        gather(bodies.shape, &Solid::shape);
        gather(bodies.locked, &Solid::locked);
        gather(bodies.damped, &Solid::damped);
        std::vector<Sym3<double>> inertia;
        inertia.reserve(solids.size());
        for (const Solid& solid : solids) { inertia.push_back(symmetric(solid.inertia)); }
        bodies.inertia.assign(inertia);
        const auto count = static_cast<std::int64_t>(solids.size());
        bodies.material.assign(std::vector<std::int32_t>(solids.size(), 0));
        bodies.force.resize(count);
        bodies.torque.resize(count);
        bodies.stiffness.resize(count);
        bodies.force.fill_zero();
        bodies.torque.fill_zero();
        bodies.stiffness.fill_zero();
        totals.resize(count);
        totals.fill_zero();
    }

    Exec                                   exec_;
    std::vector<Array<Exec, float>>        floats_;
    std::vector<Array<Exec, double>>       doubles_;
    std::vector<Array<Exec, std::int32_t>> integers_;
    std::vector<Array<Exec, Vec3<double>>> vectors_;
    Array<Exec, dem::TemplateView>         templates_;
    Array<Exec, dem::PairProperties>       properties_;
    Array<Exec, dem::Plane>                planes_;
    int                                    substeps_ = 0;
};

template<class Exec>
class DemTest : public BackendTest<Exec>
{
protected:
    using Scene = SolidScene<Exec>;
};

} // namespace tread::test
