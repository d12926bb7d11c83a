#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "backend/reduce.hpp"
#include "base/errors.hpp"
#include "solver/rigid.hpp"

// What the bodies did since the last report.
namespace tread::solver
{

template<class Exec>
RigidReport Rigid<Exec>::report(double time)
{
    RigidReport                    report;
    Array<Exec, dem::BodyActivity> activity(exec_, "body activity", bodies_.position.size());
    const ReportSums               sums = sum_for_report(activity);
    take(sums.total, report);
    report.largest_speed = sums.most.speed;
    report.net_force     = sums.all.net_force;
    report.weight_power  = sums.all.weight_power;
    report.substep       = substep_;
    if (!std::isfinite(report.net_force) || !std::isfinite(sums.all.speed))
    {
        require_finite(time);
        throw NumericalError(fmt::format("t = {:.6g} s: the sum of the forces on bodies is not a number", time));
    }
    if (contacts_)
    {
        require_resolved(time, report.largest_speed, activity);
        require_listed(time);
        report.overlap = std::max(std::exchange(overlap_, 0.0), guard(time));
    }
    return report;
}

/// All in one read.
template<class Exec>
typename Rigid<Exec>::ReportSums Rigid<Exec>::sum_for_report(Array<Exec, dem::BodyActivity>& activity)
{
    dem::measure_activity(exec_, bodies_.view(), bounding_radii_.data(), gravity_, activity.data());
    const double* values = reinterpret_cast<const double*>(activity.data());
    const double* totals = reinterpret_cast<const double*>(totals_.data());
    constexpr int width  = sizeof(dem::BodyActivity) / sizeof(double);
    double*       most   = sums_.data();
    largest_of_rows(exec_, values, activity.size(), width, most);
    sum_rows(exec_, values, activity.size(), width, most + width);
    sum_rows(exec_, totals, totals_.size(), dem::body_total_width, most + 2 * width);
    return read(exec_, reinterpret_cast<const ReportSums*>(most));
}

/// What has been added to the totals since the last report.
template<class Exec>
void Rigid<Exec>::take(const dem::BodyTotal& now, RigidReport& report)
{
    report.wall_impulse    = now.wall_impulse - taken_.wall_impulse;
    report.damping_impulse = now.damping_impulse - taken_.damping_impulse;
    report.driver_impulse  = now.holding_impulse - taken_.holding_impulse + command_impulse_;
    report.friction        = now.friction - taken_.friction;
    report.restitution     = now.restitution - taken_.restitution;
    report.damped          = now.damping - taken_.damping;
    // A velocity that is given is given as one of half a substep ago, like all of them.
    report.driver_work =
        now.holding_work - taken_.holding_work + command_work_ + 0.5 * substep_ * gravity_.dot(command_impulse_);
    report.sand_work = now.sand_work - taken_.sand_work;
    taken_           = now;
    command_impulse_.setZero();
    command_work_ = 0;
}

template RigidReport Rigid<Cpu>::report(double);
#ifdef TREAD_WITH_CUDA
template RigidReport Rigid<Gpu>::report(double);
#endif

} // namespace tread::solver
