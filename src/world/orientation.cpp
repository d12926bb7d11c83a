#include "world/orientation.hpp"

#include <numbers>

#include <Eigen/Geometry>

namespace tread::world
{
namespace
{

Quat about(const Vec3<double>& axis, double degrees)
{
    return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

Quat of_rows(const scene::Matrix3& rows)
{
    Mat3<double> rotation;
    for (int i = 0; i < 3; ++i)
    {
        for (int j = 0; j < 3; ++j) { rotation(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; }
    }
    return Quat(rotation).normalized();
}

} // namespace

Quat rotation_of(const scene::Orientation& orientation)
{
    if (orientation.rows) { return of_rows(*orientation.rows); }
    if (orientation.axis && orientation.angle_deg)
    {
        return about(Vec3<double>(orientation.axis->data()).normalized(), *orientation.angle_deg);
    }
    if (!orientation.yaw_deg && !orientation.camber_deg) { return Quat::Identity(); }
    return about(Vec3<double>::UnitZ(), orientation.yaw_deg.value_or(0)) *
           about(Vec3<double>::UnitX(), orientation.camber_deg.value_or(0));
}

} // namespace tread::world
