#include "shape/solids/source_solid.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "shape/generators/generators.hpp"
#include "shape/generators/tools.hpp"
#include "shape/solids/united.hpp"

namespace tread::shape
{
namespace
{

/// Exact sphere: volume pi/6 and moment of inertia 2/5 V r^2, r = 1/2 m.
MassProperties exact_sphere()
{
    return {std::numbers::pi / 6, Eigen::Vector3d::Zero(), std::numbers::pi / 60 * Eigen::Matrix3d::Identity()};
}

Placing placing_of(const scene::AssemblyPart& part)
{
    const Eigen::Vector3d axis = Eigen::Vector3d(part.axis.data()).normalized();
    return {part.scale, Eigen::AngleAxisd(part.angle_deg * std::numbers::pi / 180, axis).toRotationMatrix(),
            Eigen::Vector3d(part.at.data())};
}

struct MakeSolid
{
    const scene::Shape& shape;
    const std::string&  directory;
    std::string         origin;

    Solid operator()(const scene::RockGenerator& rock) const { return closed(rock_mesh(rock, origin)); }
    Solid operator()(const scene::SphereGenerator& sphere) const
    {
        Solid solid = closed(sphere_mesh(sphere, origin));
        solid.unit  = exact_sphere();
        return solid;
    }
    Solid operator()(const scene::WheelGenerator& wheel) const { return closed(wheel_mesh(wheel, origin)); }
    Solid operator()(const scene::MeshFile& file) const
    {
        const std::string path = (std::filesystem::path(directory) / file.path).string();
        return make_solid(read_mesh(path, file.unit), file.repair ? Repair::tried : Repair::none,
                          fmt::format("{}, file {}", origin, path));
    }
    Solid operator()(const scene::Assembly& assembly) const
    {
        std::vector<Solid> solids;
        for (std::size_t p = 0; p < assembly.parts.size(); ++p)
        {
            Solid part = solid_of(shape.parts[p], directory);
            place(part, placing_of(assembly.parts[p]));
            solids.push_back(std::move(part));
        }
        return united(std::move(solids), origin);
    }

    template<class Tool>
    Solid operator()(const Tool& tool) const
    {
        return closed(tool_mesh(tool));
    }

    Solid closed(TriangleMesh mesh) const
    {
        require_watertight(mesh, origin);
        const MassProperties unit = mass_properties(mesh);
        return {std::move(mesh), {}, SignRule::pseudonormal, unit, {}};
    }
};

} // namespace

Solid solid_of(const scene::Shape& shape, const std::string& directory)
{
    return std::visit(MakeSolid{shape, directory, fmt::format("shape '{}'", shape.name)}, shape.source);
}

} // namespace tread::shape
