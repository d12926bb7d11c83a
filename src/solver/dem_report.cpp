#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "base/errors.hpp"
#include "decomp/combine.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "kernels/dem/motion/sums.hpp"
#include "solver/dem_solver.hpp"

// Output of the bodies: reports for the ledger, rows for the recorder, fields for snapshots.
namespace tread::solver
{
namespace
{

template<class T>
std::vector<double> rows(const std::vector<T>& vectors)
{
    std::vector<double> out;
    for (const T& v : vectors) { out.insert(out.end(), v.data(), v.data() + v.size()); }
    return out;
}

/// m at scale 1, distance from the centre down to the lowest point; for a wheel, of the cylinder over its grousers,
/// which does not oscillate with each grouser.
double depth_below_centre(const shape::ShapeTemplate& form, const Quat& orientation)
{
    const Vec3<double> down = orientation.conjugate() * -Vec3<double>::UnitZ(); // in the body's frame
    if (form.is_wheel)
    {
        return form.wheel.radius * std::hypot(down[0], down[2]) + 0.5 * form.wheel.width * std::abs(down[1]);
    }
    if (form.sphere_radius > 0) { return form.sphere_radius; }
    double deepest = 0;
    for (const Vec3<double>& vertex : form.mesh.vertices) { deepest = std::max(deepest, down.dot(vertex)); }
    return deepest;
}

} // namespace

template<class Exec>
RigidReport DemSolver<Exec>::report(double time)
{
    if (!activity_) { request_report(); }
    synchronize(exec_);
    RigidReport      report;
    const ReportSums sums = readback_.get();
    take(sums.total, report);
    report.largest_speed = sums.most.speed;
    report.net_force     = sums.all.net_force;
    report.weight_power  = sums.all.weight_power;
    report.substep       = substep_;
    together([&] { check(report, sums.all.speed, time); });
    activity_.reset();
    if (ranks_) { add_up(report); }
    return report;
}

template<class Exec>
void DemSolver<Exec>::request_report()
{
    auto& activity = activity_.emplace(exec_, "body activity", bodies_.position.size());
    dem::measure_activity(exec_, bodies_.view(), bounding_radii_.data(), gravity_, activity.data());
    const double* values = reinterpret_cast<const double*>(activity.data());
    const double* totals = reinterpret_cast<const double*>(totals_.data());
    constexpr int width  = sizeof(dem::BodyActivity) / sizeof(double);
    double*       most   = sums_.data();
    largest_of_rows(exec_, values, activity.size(), width, most);
    sum_rows(exec_, values, activity.size(), width, most + width);
    sum_rows(exec_, totals, totals_.size(), dem::body_total_width, most + 2 * width);
    readback_.request(reinterpret_cast<const ReportSums*>(most));
    if (!contacts_) { return; }
    if (!checked_within_step_)
    {
        displacement_readback_.request(
            dem::largest_displacement(exec_, displacements_, bodies_.view(), law_.templates, pairs_.travel.data()));
    }
    overlap_readback_.request(dem::largest_overlap(exec_, pairs_, bodies_.view(), law_));
}

/// Checks this rank's bodies. A maximum of speeds hides a value that is not finite; a sum does not.
template<class Exec>
void DemSolver<Exec>::check(RigidReport& report, double sum_of_speeds, double time)
{
    if (!std::isfinite(report.net_force) || !std::isfinite(sum_of_speeds))
    {
        require_finite(time);
        throw NumericalError(fmt::format("t = {:.6g} s: the sum of the forces on bodies is not a number", time));
    }
    if (!contacts_) { return; }
    require_resolved(time, report.largest_speed);
    if (!checked_within_step_) { require_listed(time, displacement_readback_.get()); }
    report.overlap = std::max(std::exchange(overlap_, 0.0), guard(time, overlap_readback_.get()));
}

template<class Exec>
void DemSolver<Exec>::add_up(RigidReport& report) const
{
    decomp::combine(ranks_->communicator(), reinterpret_cast<double*>(&report), rigid_report_sums, rigid_report_peaks);
}

/// Adds the increase of the totals since the last report.
template<class Exec>
void DemSolver<Exec>::take(const dem::BodyTotal& now, RigidReport& report)
{
    report.wall_impulse    = now.wall_impulse - taken_.wall_impulse;
    report.damping_impulse = now.damping_impulse - taken_.damping_impulse;
    report.driver_impulse  = now.holding_impulse - taken_.holding_impulse + command_impulse_;
    report.friction        = now.friction - taken_.friction;
    report.restitution     = now.restitution - taken_.restitution;
    report.damped          = now.damping - taken_.damping;
    // Velocities are those of half a substep earlier; so are commanded ones.
    report.driver_work =
        now.holding_work - taken_.holding_work + command_work_ + 0.5 * substep_ * gravity_.dot(command_impulse_);
    report.sand_work = now.sand_work - taken_.sand_work;
    taken_           = now;
    command_impulse_.setZero();
    command_work_ = 0;
}

template<class Exec>
RigidCensus DemSolver<Exec>::census()
{
    const dem::BodySums sums = dem::sum_bodies(exec_, pairs_, bodies_.view(), totals_, gravity_);
    RigidCensus         now{0, sums.kinetic, sums.contact, sums.potential, sums.momentum};
    if (ranks_) { ranks_->sum(now); }
    now.mass = mass_;
    return now;
}

template<class Exec>
std::vector<BodyRow> DemSolver<Exec>::named_bodies()
{
    if (ranks_) { ranks_->collect(bodies_); }
    std::vector<BodyRow>            bodies;
    const std::vector<Quat>         orientation = bodies_.orientation.to_host();
    const std::vector<Vec3<double>> position = bodies_.position.to_host(), velocity = bodies_.velocity.to_host(),
                                    spin            = bodies_.angular_velocity.to_host();
    const std::vector<dem::ContactImpulse> impulses = summed_impulses();
    for (std::size_t b = 0; b < static_cast<std::size_t>(named_); ++b)
    {
        const auto&        form = world_.templates[static_cast<std::size_t>(world_.bodies.shape[b])];
        const double       over = mean_time_ > 0 ? 1 / mean_time_ : 0;
        const Vec3<double> axle = orientation[b] * Vec3<double>::UnitY();
        const double       drop = world_.bodies.scale[b] * depth_below_centre(form, orientation[b]);
        bodies.push_back({position[b], velocity[b], spin[b], over * impulses[b].linear, over * impulses[b].angular,
                          axle, position[b][2] - drop});
    }
    return bodies;
}

/// Sums over all ranks, since begin_mean().
template<class Exec>
std::vector<dem::ContactImpulse> DemSolver<Exec>::summed_impulses() const
{
    std::vector<dem::ContactImpulse> impulses = impulses_.to_host();
    if (ranks_)
    {
        for (dem::ContactImpulse& impulse : impulses) { ranks_->sum(impulse); }
    }
    return impulses;
}

template<class Exec>
Vec3<double> DemSolver<Exec>::place(std::size_t body) const
{
    const bool   here = !ranks_ || ranks_->owns(static_cast<std::int64_t>(body));
    Vec3<double> at   = here ? read(exec_, bodies_.position.data() + body) : Vec3<double>(Vec3<double>::Zero());
    if (ranks_) { ranks_->sum(at); }
    return at;
}

template<class Exec>
double DemSolver<Exec>::carried(std::size_t body) const
{
    const Vec3<double> impulse = kept_impulses_[body] + summed_impulses()[body].linear;
    return -impulse.dot(gravity_) / (world_.bodies.mass[body] * gravity_.squaredNorm());
}

template<class Exec>
void DemSolver<Exec>::begin_mean()
{
    const std::vector<dem::ContactImpulse> impulses = summed_impulses();
    for (std::size_t b = 0; b < impulses.size(); ++b) { kept_impulses_[b] += impulses[b].linear; }
    impulses_.fill_zero();
    mean_time_ = 0;
}

template<class Exec>
io::BodyFields DemSolver<Exec>::fields()
{
    if (ranks_) { ranks_->collect(bodies_); }
    io::BodyFields fields;
    fields.position = rows(bodies_.position.to_host());
    for (const Quat& q : bodies_.orientation.to_host())
    {
        for (const double value : {q.w(), q.x(), q.y(), q.z()}) { fields.orientation.push_back(value); }
    }
    fields.velocity         = rows(bodies_.velocity.to_host());
    fields.angular_velocity = rows(bodies_.angular_velocity.to_host());
    fields.scale            = bodies_.scale.to_host();
    fields.shape            = bodies_.shape.to_host();
    return fields;
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template RigidReport          DemSolver<Exec>::report(double);                                                     \
    template void                 DemSolver<Exec>::request_report();                                                   \
    template RigidCensus          DemSolver<Exec>::census();                                                           \
    template std::vector<BodyRow> DemSolver<Exec>::named_bodies();                                                     \
    template Vec3<double>         DemSolver<Exec>::place(std::size_t) const;                                           \
    template double               DemSolver<Exec>::carried(std::size_t) const;                                         \
    template void                 DemSolver<Exec>::begin_mean();                                                       \
    template io::BodyFields       DemSolver<Exec>::fields()
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
