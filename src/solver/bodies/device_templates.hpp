#pragma once

#include <cstdint>
#include <vector>

#include "backend/array.hpp"
#include "kernels/dem/templates.hpp"
#include "shape/template.hpp"

namespace tread::solver
{

/// The scene's templates in a backend's memory; views() is the kernel argument.
template<class Exec>
class DeviceTemplates
{
public:
    DeviceTemplates(const Exec& exec, const std::vector<shape::ShapeTemplate>& templates);

    const dem::TemplateView* views() const { return views_.data(); }

    /// Whether a template may touch another body at several separate places.
    bool concave() const { return concave_; }

private:
    Array<Exec, float>             sdf_values_;
    Array<Exec, std::int32_t>      sdf_slots_;
    Array<Exec, float>             sdf_corners_;
    Array<Exec, Vec3<double>>      node_positions_;
    Array<Exec, double>            node_areas_;
    Array<Exec, Vec3<double>>      part_centres_;
    Array<Exec, double>            part_radii_;
    Array<Exec, dem::TemplateView> views_;
    bool                           concave_ = false;
};

} // namespace tread::solver
