#pragma once

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "kernels/dem/motion/sums.hpp"

// Steps of sum_bodies, for both backends; sums.cpp and sums.cu provide for_each.
namespace tread::dem::sums
{

/// The part of BodySums that is a sum of one value per body.
struct BodyRow
{
    double       kinetic;
    double       potential;
    Vec3<double> momentum;
    Vec3<double> spin;
};
inline constexpr int body_row_width = sizeof(BodyRow) / sizeof(double);

struct WriteBodyRow
{
    BodiesView   bodies;
    Vec3<double> gravity;
    double*      rows;

    TREAD_HD void operator()(std::int64_t b) const
    {
        double* row = rows + b * body_row_width;
        if (!bodies.is_owned(b))
        {
            for (int c = 0; c < body_row_width; ++c) { row[c] = 0; }
            return;
        }
        const Mat3<double> rotation = bodies.orientation[b].toRotationMatrix();
        const Vec3<double> omega    = bodies.angular_velocity[b];
        const Vec3<double> angular  = rotation * (full(bodies.inertia[b]) * (rotation.transpose() * omega));
        const Vec3<double> momentum = bodies.mass[b] * bodies.velocity[b];
        const Vec3<double> spin     = bodies.position[b].cross(momentum) + angular;
        row[0]                      = 0.5 * (momentum.dot(bodies.velocity[b]) + angular.dot(omega));
        row[1]                      = -bodies.mass[b] * gravity.dot(bodies.position[b]);
        for (int c = 0; c < 3; ++c)
        {
            row[2 + c] = momentum[c];
            row[5 + c] = spin[c];
        }
    }
};

} // namespace tread::dem::sums

namespace tread::dem
{

template<class Exec>
BodySums sum_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyTotals<Exec>& totals,
                    const Vec3<double>& gravity)
{
    using namespace sums;
    const std::int64_t rows = bodies.count * body_row_width, count = pairs.key.size();
    pairs.measure.resize(rows + body_row_width + body_total_width + 1);
    double* result = pairs.measure.data() + rows;
    for_each(exec, "body sums", bodies.count, WriteBodyRow{bodies, gravity, pairs.measure.data()});
    sum_rows(exec, pairs.measure.data(), bodies.count, body_row_width, result);
    sum_rows(exec, reinterpret_cast<const double*>(totals.data()), totals.size(), body_total_width,
             result + body_row_width);
    sum_rows(exec, pairs.answers.energy.data(), count, 1, result + body_row_width + body_total_width);

    struct Result
    {
        BodyRow   row;
        BodyTotal total;
        double    contact;
    };
    const Result found   = read(exec, reinterpret_cast<const Result*>(result));
    const double contact = found.contact + pairs.sleep.energy;
    return {found.row.kinetic, found.row.potential, found.row.momentum, found.row.spin, contact, found.total};
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template BodySums sum_bodies(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyTotals<Exec>&,                \
                                 const Vec3<double>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
