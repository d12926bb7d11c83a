#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/bed_file.hpp"
#include "scene_text.hpp"
#include "world/host_points.hpp"

// Beds of all kinds, to be made in parts.
namespace tread::test
{

struct BedScene
{
    std::string  name;
    scene::Scene scene;
};

/// Clay under a slope, sand that moves in the box above.
inline std::string two_materials_text()
{
    std::string       text  = sand_text;
    const std::string table = "[[terrain]]\nmaterial = \"sand\"\n";
    const std::string clay  = R"([[material]]
name    = "clay"
model   = "elastic"
density = 2000.0
young   = 1.0e6
poisson = 0.4
[[terrain]]
material = "clay"
height   = "0.1 + 0.3*x"
[[terrain]]
material = "sand"
velocity = [0.0, 0.1, 0.0]
)";
    return text.replace(text.find(table), table.size(), clay);
}

/// Saves all sand of a scene as if it had settled, each point with a stress and a strain of its own.
inline void save_as_bed(const scene::Scene& scene, const std::string& path)
{
    const world::World      built = world::build_world(scene);
    const world::HostPoints made  = world::make_points(scene, built, built.sand.rows);
    io::BedFile             bed;
    io::BedPoints&          points = bed.points;
    points.grid_spacing            = scene.grid.spacing;
    for (const scene::Material& one : scene.materials)
    {
        points.materials.push_back({one.name, one.density, one.young, one.poisson, one.young_pressure});
    }
    points.material.assign(made.material.begin(), made.material.end());
    points.volume = made.volume;
    points.mass   = made.mass;
    for (std::size_t i = 0; i < made.size(); ++i)
    {
        points.position.insert(points.position.end(), made.position[i].data(), made.position[i].data() + 3);
        points.stress.insert(points.stress.end(), made.stress[i].data(), made.stress[i].data() + 6);
        points.plastic_shear.push_back(1e-6 * static_cast<double>(i));
    }
    io::write_bed(path, bed);
}

/// `folder`: keeps the saved bed that one of the scenes reads.
inline std::vector<BedScene> bed_scenes(const TemporaryDirectory& folder)
{
    const std::vector<std::string> fine{"grid.spacing=0.02"};
    const std::string              path = folder.path("bed.h5"), region = "region   = { box = [[0.0, 0.0, 0.0], ";
    save_as_bed(load_text(sand_text, fine), path);
    std::string       saved = sand_text;
    const std::size_t at    = saved.find(region);
    saved.replace(at, saved.find('\n', at) - at,
                  fmt::format("from = \"{}\"\n[[terrain]]\nmaterial = \"sand\"\n"
                              "region = {{ box = [[0.0, 0.0, 0.1], [0.2, 0.2, 0.3]] }}",
                              path));
    return {{"plain", load_text(sand_text, fine)},
            {"two materials", load_text(two_materials_text(), fine)},
            {"rocks in sand", load_text(sand_text + rocks_text, fine)},
            {"saved bed under sand", load_text(saved, fine)},
            {"refined grid",
             load_text(sand_text, {"grid.spacing=0.02", "grid.refine=[[[0.12, 0.12, 0.1], [0.28, 0.28, 0.3]]]"})}};
}

} // namespace tread::test
