#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "backend.hpp"
#include "kernels/contact/substeps.hpp"
#include "kernels/mpm/pages/order.hpp"

// A few bodies with analytic shapes and a few points, for tests of sand-body contact.
namespace tread::test
{

/// Signed distance of a template, sampled on a grid of `cells` along the longest axis of the box enlarged by a fifth.
struct AnalyticShape
{
    AnalyticShape(const Vec3<double>& half_extent, double equivalent, int cells,
                  std::function<double(const Vec3<double>&)> exact_distance)
        : half(half_extent)
        , equivalent_radius(equivalent)
        , spacing(2.4 * half_extent.maxCoeff() / cells)
        , distance(std::move(exact_distance))
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            const double extent                  = 2.4 * half[static_cast<Eigen::Index>(c)];
            nodes[c]                             = static_cast<std::int32_t>(std::ceil(extent / spacing)) + 1;
            origin[static_cast<Eigen::Index>(c)] = -0.5 * spacing * (nodes[c] - 1);
        }
        for (int k = 0; k < nodes[2]; ++k)
        {
            for (int j = 0; j < nodes[1]; ++j)
            {
                for (int i = 0; i < nodes[0]; ++i)
                {
                    const Vec3<double> x = origin + spacing * Vec3<double>(i, j, k);
                    values.push_back(static_cast<float>(distance(x)));
                }
            }
        }
    }

    Vec3<double>                half;
    double                      equivalent_radius;
    double                      spacing;
    Vec3<double>                origin = Vec3<double>::Zero();
    std::array<std::int32_t, 3> nodes{};
    std::vector<float>          values;

    std::function<double(const Vec3<double>&)> distance; ///< exact, body frame at scale 1
};

inline AnalyticShape sphere_shape(double radius, int cells)
{
    return {Vec3<double>::Constant(radius), radius, cells, [=](const Vec3<double>& x) { return x.norm() - radius; }};
}

inline AnalyticShape box_shape(const Vec3<double>& half, double equivalent_radius, int cells)
{
    return {half, equivalent_radius, cells,
            [=](const Vec3<double>& x)
            {
                const Vec3<double> q = x.cwiseAbs() - half;
                return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
            }};
}

struct BodyState
{
    Vec3<double> position;
    Quat         orientation      = Quat::Identity();
    Vec3<double> velocity         = Vec3<double>::Zero();
    Vec3<double> angular_velocity = Vec3<double>::Zero();
    double       scale            = 1;
    std::int32_t shape            = 0;
};

struct PointState
{
    Vec3<double> position;
    Vec3<double> velocity = Vec3<double>::Zero();
    Vec3<double> support  = Vec3<double>::Zero();
};

/// Material 0 = sand, 1 = bodies, 2 = walls; all pairs have the same properties.
struct SceneNumbers
{
    double               spacing       = 0.01;    ///< m, grid
    double               mass          = 1e-3;    ///< kg, of a point
    double               volume        = 1.25e-7; ///< m3, of a point
    dem::PairProperties  pair          = {1e6, 3e5, 0.3, 0.0};
    contact::PointMotion motion        = contact::PointMotion::supported;
    double               dt            = 1e-4; ///< s, MPM step
    double               point_drift   = 0;    ///< m
    double               point_speed   = 1;    ///< m/s
    double               sampled_below = 0;    ///< m
    double               skin          = 0;    ///< m
};

template<class Exec, class Real>
class ContactScene
{
public:
    ContactScene(const Exec& exec, const std::vector<AnalyticShape>& shapes, const std::vector<BodyState>& states,
                 const std::vector<PointState>& sand, const SceneNumbers& scene_numbers = {})
        : numbers(scene_numbers)
        , bodies(exec)
        , points(exec)
        , contact(exec)
        , pairs(exec)
        , totals(exec, "test totals")
        , exec_(exec)
        , pages_(exec)
        , scratch_(exec)
        , templates_(exec, "test templates")
        , pairs_(exec, "test pairs")
    {
        make_shapes(shapes);
        make_bodies(states);
        make_points(sand);
        pairs_.assign(std::vector<dem::PairProperties>(9, numbers.pair));
        order();
    }

    /// Orders points by page and cell, as the solver does.
    void order() { order_points(exec_, points, pages_, {numbers.spacing, shift, Vec3<double>(1, 1, 1)}, scratch_); }

    contact::SearchReach reach() const
    {
        const double radius = contact::point_radius(numbers.volume, contact::RadiusRule::sphere);
        return {numbers.dt,
                numbers.point_speed,
                numbers.point_drift,
                radius * (1 + 1e-6),
                numbers.sampled_below,
                numbers.skin,
                listed};
    }

    contact::PointBodyLaw law() const
    {
        return {templates_.data(),           {pairs_.data(), 3}, 1.0,
                contact::RadiusRule::sphere, numbers.motion,     numbers.sampled_below};
    }

    void find()
    {
        find_candidates(exec_, contact.candidates, points.view(), page_view(), bodies.view(), templates_.data(),
                        law().pairs, contact::RadiusRule::sphere, reach());
    }
    void begin() { begin_step(exec_, contact, points.view(), page_view(), bodies.view(), law(), reach()); }
    void begin_kept() { begin_kept_step(exec_, contact, points.view(), law()); }
    /// Applies the contact forces of sand to the bodies.
    void substep(double dt)
    {
        contact::substep(exec_, contact, bodies.view(), law(), dt);
        if (contact.candidates.body.size() == 0) { return clear_wrenches(); }
        const auto                run   = contact.run_of_body.to_host();
        const auto                first = contact.candidates.body_parts.first_of_run.to_host();
        const auto                parts = contact.wrench_sums.to_host();
        std::vector<Vec3<double>> force, torque;
        std::vector<double>       stiffness;
        for (const std::int32_t r : run)
        {
            dem::ContactWrench sum = dem::ContactWrench::zero();
            if (r >= 0)
            {
                const auto own = static_cast<std::size_t>(r);
                for (std::int32_t i = first[own]; i < first[own + 1]; ++i)
                {
                    sum = sum + parts[static_cast<std::size_t>(i)];
                }
            }
            force.push_back(sum.force);
            torque.push_back(sum.torque);
            stiffness.push_back(sum.stiffness);
        }
        bodies.force.assign(force);
        bodies.torque.assign(torque);
        bodies.stiffness.assign(stiffness);
    }
    void finish() { finish_step(exec_, contact, points.view(), numbers.dt); }

    /// Contact history records, sorted by key.
    std::vector<contact::HistoryRecord> records()
    {
        keep_history(exec_, contact);
        return read_out(contact.history);
    }

    contact::Summary summary()
    {
        return contact.candidates.body.size() == 0 ? contact::Summary::zero()
                                                   : read(exec_, summarise(exec_, contact, 1));
    }

    /// Step of bodies of 1 kg that touch only sand.
    dem::BodyStep<Exec> body_step(double dt)
    {
        return {pairs, bodies.view(), {}, totals.data(), {nullptr, 0}, {{0, 0, -9.8}, 0, dt, contact.wrenches()}};
    }

    void clear_wrenches()
    {
        bodies.force.fill_zero();
        bodies.torque.fill_zero();
        bodies.stiffness.fill_zero();
    }

    /// World position of each point, in memory order.
    std::vector<Vec3<double>> positions() const
    {
        const std::vector<double> planes = points.position.to_host();
        std::vector<Vec3<double>> found;
        for (std::size_t i = 0, n = static_cast<std::size_t>(points.stride); i < n; ++i)
        {
            found.emplace_back(planes[i], planes[n + i], planes[2 * n + i]);
        }
        return found;
    }

    /// Contact force on each point, in memory order.
    std::vector<Vec3<double>> contact_forces() const
    {
        const std::vector<Real>   planes = points.contact_force.to_host();
        std::vector<Vec3<double>> found;
        for (std::size_t i = 0, n = static_cast<std::size_t>(points.stride); i < n; ++i)
        {
            found.emplace_back(planes[i], planes[n + i], planes[2 * n + i]);
        }
        return found;
    }

    /// Host view of a template, for item functions.
    dem::TemplateView host_template(const AnalyticShape& shape) const { return view_of(shape, shape.values.data()); }

    SceneNumbers                numbers;
    dem::ListedPlaces           listed; ///< of the next search
    dem::Bodies<Exec>           bodies;
    mpm::Points<Exec, Real>     points;
    contact::PointContact<Exec> contact;
    dem::Pairs<Exec>            pairs; ///< always empty
    dem::BodyTotals<Exec>       totals;

private:
    static constexpr double shift = 0.5;

    mpm::PagesView page_view() const { return pages_.view(numbers.spacing, shift); }

    static dem::TemplateView view_of(const AnalyticShape& shape, const float* values)
    {
        dem::TemplateView view{};
        view.sdf.origin          = shape.origin;
        view.sdf.spacing         = shape.spacing;
        view.sdf.inverse_spacing = 1 / shape.spacing;
        view.sdf.steepest        = std::sqrt(3.0);
        std::copy(shape.nodes.begin(), shape.nodes.end(), view.sdf.nodes);
        view.sdf.values        = values;
        view.low               = -shape.half;
        view.high              = shape.half;
        view.bounding_radius   = shape.half.norm();
        view.equivalent_radius = shape.equivalent_radius;
        return view;
    }

    void make_shapes(const std::vector<AnalyticShape>& shapes)
    {
        std::vector<dem::TemplateView> views;
        for (const AnalyticShape& shape : shapes)
        {
            values_.emplace_back(exec_, "test sdf");
            values_.back().assign(shape.values);
            views.push_back(view_of(shape, values_.back().data()));
        }
        templates_.assign(views);
    }

    void make_bodies(const std::vector<BodyState>& states)
    {
        const auto gather = [&](auto& array, auto member)
        {
            std::vector<std::remove_cvref_t<decltype(states[0].*member)>> values;
            for (const BodyState& state : states) { values.push_back(state.*member); }
            array.assign(values);
        };
        gather(bodies.position, &BodyState::position);
        gather(bodies.orientation, &BodyState::orientation);
        gather(bodies.velocity, &BodyState::velocity);
        gather(bodies.angular_velocity, &BodyState::angular_velocity);
        gather(bodies.scale, &BodyState::scale);
        gather(bodies.shape, &BodyState::shape);
        bodies.material.assign(std::vector<std::int32_t>(states.size(), 1));
        bodies.mass.assign(std::vector<double>(states.size(), 1.0));
        bodies.inertia.assign(std::vector<Sym3<double>>(states.size(), symmetric<double>(Mat3<double>::Identity())));
        bodies.locked.assign(std::vector<std::uint32_t>(states.size(), 0));
        bodies.damped.assign(std::vector<std::int32_t>(states.size(), 0));
        totals.resize(static_cast<std::int64_t>(states.size()));
        totals.fill_zero();
        bodies.force.resize(static_cast<std::int64_t>(states.size()));
        bodies.torque.resize(static_cast<std::int64_t>(states.size()));
        bodies.stiffness.resize(static_cast<std::int64_t>(states.size()));
    }

    void make_points(const std::vector<PointState>& sand)
    {
        const std::size_t          n = sand.size();
        std::vector<double>        position(3 * n);
        std::vector<Real>          velocity(3 * n), support(3 * n);
        std::vector<std::uint32_t> id(n);
        for (std::size_t i = 0; i < n; ++i)
        {
            id[i] = static_cast<std::uint32_t>(1000 + i);
            for (std::size_t c = 0; c < 3; ++c)
            {
                const auto axis     = static_cast<Eigen::Index>(c);
                position[c * n + i] = sand[i].position[axis];
                velocity[c * n + i] = static_cast<Real>(sand[i].velocity[axis]);
                support[c * n + i]  = static_cast<Real>(sand[i].support[axis]);
            }
        }
        points.allocate(static_cast<std::int64_t>(n), {.affine = false, .plastic = false, .coupled = true});
        points.position.assign(position);
        points.grid_velocity.assign(velocity);
        points.support.assign(support);
        points.id.assign(id);
        points.mass.assign(std::vector<Real>(n, static_cast<Real>(numbers.mass)));
        points.volume.assign(std::vector<Real>(n, static_cast<Real>(numbers.volume)));
    }

    Exec                             exec_;
    mpm::Pages<Exec>                 pages_;
    mpm::OrderScratch<Exec, Real>    scratch_;
    std::vector<Array<Exec, float>>  values_;
    Array<Exec, dem::TemplateView>   templates_;
    Array<Exec, dem::PairProperties> pairs_;
};

/// Backend and precision of point fields.
template<class ExecType, class RealType>
struct ContactCase
{
    using Exec = ExecType;
    using Real = RealType;
};

using ContactCases = BackendAndRealList<::testing::Types, ContactCase>;

struct ContactCaseNames
{
    template<class Case>
    static std::string GetName(int)
    {
        return BackendNames::GetName<typename Case::Exec>(0) +
               (sizeof(typename Case::Real) == 4 ? "_float" : "_double");
    }
};

template<class Case>
class ContactTest : public BackendTest<typename Case::Exec>
{
protected:
    using Scene = ContactScene<typename Case::Exec, typename Case::Real>;
};

} // namespace tread::test
