#pragma once

#include <vector>

#include "base/random.hpp"
#include "dem_scene.hpp"
#include "kernels/dem/contact/ray_shape.hpp"
#include "shape/flat_tree.hpp"
#include "shape/template.hpp"

// Shapes with meshes, for bodies whose contacts use rays.
namespace tread::test
{

/// Converts a generated shape to the shapes of these tests.
inline SolidShape solid_of(const shape::ShapeTemplate& form)
{
    SolidShape solid;
    solid.spacing           = form.sdf.spacing;
    solid.origin            = form.sdf.origin;
    solid.nodes             = form.sdf.nodes;
    solid.values            = form.sdf.values;
    solid.slots             = form.sdf.slots;
    solid.corners           = form.sdf.corners;
    solid.bricks            = form.sdf.bricks;
    solid.fine_reach        = form.sdf.fine_reach;
    solid.positions         = form.nodes.positions;
    solid.areas             = form.nodes.areas;
    solid.centres           = form.nodes.part_centres;
    solid.radii             = form.nodes.part_radii;
    solid.half              = form.box.low.cwiseAbs().cwiseMax(form.box.high.cwiseAbs());
    solid.bounding_radius   = form.bounding_radius;
    solid.equivalent_radius = form.equivalent_radius;
    return solid;
}

inline dem::RayShape rays_of(const shape::TriangleMesh& mesh, const std::vector<Vec3<double>>& nodes)
{
    const shape::TriangleTree tree = shape::build_tree(mesh);
    return dem::make_ray_shape(shape::flatten(tree), nodes, shape::surface_normals(mesh, tree, nodes));
}

/// Ray data of one shape in a backend's memory.
template<class Exec>
class Rays
{
public:
    Rays(const Exec& exec, const dem::RayShape& shape)
        : boxes_(exec, "test boxes")
        , triangles_(exec, "test triangles")
        , inward_(exec, "test normals")
        , length_(exec, "test lengths")
        , views_(exec, "test rays")
    {
        boxes_.assign(shape.boxes);
        triangles_.assign(shape.triangles);
        inward_.assign(shape.inward);
        length_.assign(shape.length);
        dem::RayView view = shape.view();
        view.boxes        = boxes_.data();
        view.triangles    = triangles_.data();
        view.inward       = inward_.data();
        view.length       = length_.data();
        views_.assign({view});
    }

    const dem::RayView* views() const { return views_.data(); }

private:
    Array<Exec, dem::RayBox>      boxes_;
    Array<Exec, dem::RayTriangle> triangles_;
    Array<Exec, Vec3<double>>     inward_;
    Array<Exec, double>           length_;
    Array<Exec, dem::RayView>     views_;
};

/// A concave rock with an equivalent diameter of 1 m.
inline shape::ShapeTemplate dented_rock(int nodes, int sdf_cells)
{
    scene::RockGenerator rock;
    rock.seed       = 5;
    rock.nodes      = nodes;
    rock.sphericity = 0.8;
    rock.solidity   = 0.85;
    scene::Shape shape;
    shape.name      = "dented";
    shape.source    = rock;
    shape.sdf_cells = sdf_cells;
    return shape::make_template(shape, ".");
}

/// One rock of a shape with diameter 0.2 m and mass 10 kg.
inline Solid rock_solid(const shape::ShapeTemplate& form)
{
    Solid solid;
    solid.scale   = 0.2;
    solid.mass    = 10;
    solid.inertia = form.unit.inertia * (solid.mass / form.unit.volume * solid.scale * solid.scale);
    return solid;
}

inline Quat random_turn(Random& random)
{
    const auto part = [&] { return random.uniform(-1, 1); };
    return Quat(part(), part(), part(), part()).normalized();
}

/// Two rocks of one shape in an off-centre collision at 1 m/s, with random orientations.
inline std::vector<Solid> off_centre_rocks(const shape::ShapeTemplate& form, Random& random)
{
    Solid first = rock_solid(form), second = first;
    first.orientation  = random_turn(random);
    second.orientation = random_turn(random);
    first.position     = {-0.135, 0, 0};
    second.position    = {0.135, 0.05, 0.02};
    first.velocity     = {0.5, 0, 0};
    second.velocity    = {-0.5, 0, 0};
    return {first, second};
}

/// Result of an impact, after the bodies have separated.
struct RockImpact
{
    double energy   = 0; ///< relative change
    double force    = 0; ///< N, largest
    double exchange = 0; ///< largest contact energy over the initial kinetic energy
    double momentum = 0; ///< N s, error
    double spin     = 0; ///< N m s, error
};

template<class Scene>
RockImpact impact_of(Scene& scene, double dt, double duration)
{
    const dem::BodySums before = scene.sums();
    RockImpact          found;
    for (int block = 0; block < static_cast<int>(duration / dt) / 20; ++block)
    {
        scene.run(dt, 20);
        found.force    = std::max(found.force, scene.bodies.force.to_host()[0].norm());
        found.exchange = std::max(found.exchange, scene.sums().contact / before.kinetic);
    }
    const dem::BodySums after = scene.sums();
    found.energy              = (after.kinetic + after.contact) / before.kinetic - 1;
    found.momentum            = (after.momentum - before.momentum).norm();
    found.spin                = (after.spin - before.spin).norm();
    return found;
}

} // namespace tread::test
