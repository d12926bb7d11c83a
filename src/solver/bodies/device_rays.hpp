#pragma once

#include <vector>

#include "backend/array.hpp"
#include "kernels/dem/contact/ray_shape.hpp"
#include "shape/template.hpp"

namespace tread::solver
{

/// Data of a template for the narrow phase by rays.
dem::RayShape ray_shape(const shape::ShapeTemplate& form);

/// Ray data of the scene's templates in a backend's memory. Without templates it is empty and views() is null.
template<class Exec>
class DeviceRays
{
public:
    DeviceRays(const Exec& exec, const std::vector<shape::ShapeTemplate>& templates);

    const dem::RayView* views() const { return views_.size() > 0 ? views_.data() : nullptr; }

private:
    Array<Exec, dem::RayBox>      boxes_;
    Array<Exec, dem::RayTriangle> triangles_;
    Array<Exec, Vec3<double>>     inward_;
    Array<Exec, double>           length_;
    Array<Exec, dem::RayView>     views_;
};

} // namespace tread::solver
