#pragma once

#include <vector>

#include "backend/array.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "solver/bodies/device_rays.hpp"
#include "solver/bodies/device_templates.hpp"
#include "solver/plan.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// Constants of a scene's bodies in a backend's memory: shapes, contact law, walls and bounding spheres.
template<class Exec>
struct BodyTables
{
    BodyTables(const Exec& exec, const scene::Scene& scene, const world::World& world, const Plan& plan);

    DeviceTemplates<Exec>            templates;
    DeviceRays<Exec>                 rays;
    Array<Exec, dem::PairProperties> properties; ///< of pairs of materials
    Array<Exec, dem::Plane>          planes;
    Array<Exec, double>              bounding_radii;          ///< m, by body, written with the bodies
    double                           smallest_radius = 0;     ///< m, of the bounding spheres
    bool                             rolling         = false; ///< whether some pair of materials has rolling friction
    dem::BodyLaw                     law{};                   ///< view of the tables
};

} // namespace tread::solver
