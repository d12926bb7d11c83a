#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "physics/harness.hpp"
#include "shape/mesh/mesh.hpp"
#include "temporary_directory.hpp"
#include "unit/shape/meshes.hpp"

// Strip footing in plane strain (docs/verification.md#strip-footing): half of the problem, with a plane of symmetry at
// x = 0, one cell thick in y. The footing is a rigid body so heavy that no load slows it.
namespace tread::test
{

struct Footing
{
    std::string soil;                  ///< keys of the soil's [[material]]; Poisson's ratio is one of them
    double      poisson       = 0.3;   ///< of the soil
    double      density       = 1000;  ///< kg/m3, of the soil
    double      weight        = 0;     ///< N/m3, of the soil; its stress at rest is that of uniaxial strain
    double      surcharge     = 0;     ///< Pa, on the whole surface; included in the pressure under the footing
    double      width         = 0.1;   ///< m, B
    int         cells         = 5;     ///< of the grid across B / 2
    double      reach         = 2;     ///< width of the soil from the centre, in B
    double      depth         = 1;     ///< in B
    double      speed         = 0.02;  ///< m/s; waves have a stress of some rho c_s times this
    double      settlement    = 0.015; ///< at the end, in B
    double      pic_rate      = 0.01;  ///< c_p/h
    std::string volume_strain = "cell-average";
};

/// Mean pressure under the footing at a settlement.
struct FootingLoad
{
    double settlement; ///< in B
    double pressure;   ///< Pa
};

/// Edge length of a cell, m.
inline double spacing(const Footing& footing) { return 0.5 * footing.width / footing.cells; }

/// No local damping: it takes a share of every unbalanced force, and acts on steady flow as friction. A point's contact
/// radius is half its spacing, so that the top row just touches.
inline std::string footing_scene(const Footing& footing, const std::string& mesh)
{
    const double h = spacing(footing), across = footing.reach * footing.width, deep = footing.depth * footing.width;
    return fmt::format(R"(
title = "strip footing"
[domain]
size    = [{across}, {h}, {top}]
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = {h}
[numerics]
precision     = "double"
volume_strain = "{volume_strain}"
pic_rate      = {pic_rate}
point_radius  = "semi-domain"
[[material]]
name    = "soil"
density = {density}
poisson = {poisson}
{soil}
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e8
poisson = 0.0
[[contact]]
between  = ["soil", "steel"]
friction = 10.0
[[terrain]]
material = "soil"
region   = {{ box = [[0.0, 0.0, 0.0], [{across}, {h}, {deep}]] }}
[[shape]]
name      = "block"
file      = "{mesh}"
sdf_cells = 60
[[body]]
name     = "footing"
shape    = "block"
material = "steel"
mass     = 1.0e6
position = [{middle}, {half_h}, {height}]
velocity = [0.0, 0.0, -{speed}]
lock     = ["x", "y", "roll", "pitch", "yaw"]
[[phase]]
name     = "push"
duration = {duration}
)",
                       fmt::arg("across", across), fmt::arg("h", h), fmt::arg("top", deep + 8 * h),
                       fmt::arg("volume_strain", footing.volume_strain), fmt::arg("pic_rate", footing.pic_rate),
                       fmt::arg("density", footing.density), fmt::arg("poisson", footing.poisson),
                       fmt::arg("soil", footing.soil), fmt::arg("deep", deep), fmt::arg("mesh", mesh),
                       fmt::arg("middle", 0.25 * footing.width), fmt::arg("half_h", 0.5 * h),
                       fmt::arg("height", deep + 2.0001 * h), fmt::arg("speed", footing.speed),
                       fmt::arg("duration", footing.settlement * footing.width / footing.speed));
}

template<class Exec>
class FootingTest
{
public:
    FootingTest(const Exec& exec, const Footing& footing)
        : footing_(footing)
        , experiment_(exec, footing_scene(footing, write_block()))
    {
        if (footing.weight > 0 || footing.surcharge > 0) { load(); }
    }

    /// Runs the test; each load is a mean over one of `samples` equal parts of the settlement.
    std::vector<FootingLoad> run(int samples)
    {
        std::vector<FootingLoad> loads;
        const double             part = footing_.settlement * footing_.width / footing_.speed / samples;
        double                   last = 0;
        experiment_.simulation().begin_mean();
        experiment_.run(
            [&](double time)
            {
                if (!pull_.empty()) { pull(time - last); }
                last = time;
                if (time < part * static_cast<double>(loads.size() + 1) - 1e-9) { return; }
                const double force = experiment_.simulation().named_bodies().at(0).force[2];
                loads.push_back({footing_.speed * time / footing_.width,
                                 footing_.surcharge + force / (0.5 * footing_.width * spacing(footing_))});
                experiment_.simulation().begin_mean();
            });
        return loads;
    }

private:
    /// The block keeps a twentieth of a cell from the walls, which it must not touch.
    std::string write_block()
    {
        const double      h    = spacing(footing_);
        const std::string path = folder_.path("block.stl");
        shape::write_stl(box_mesh({0, 0, 0}, {0.5 * footing_.width - 0.05 * h, 0.95 * h, 4 * h}), path);
        return path;
    }

    /// Sets the stress at rest and its loads: weight and surcharge are applied as point accelerations, because the
    /// scene's gravity would pull the footing.
    void load()
    {
        auto&        points   = experiment_.simulation().sand().points();
        const auto   position = points.position.to_host();
        const auto   id       = points.id.to_host();
        auto         stress   = points.stress.to_host();
        const double sideways = footing_.poisson / (1 - footing_.poisson), row = 0.5 * spacing(footing_);
        const auto   n = id.size();
        pull_.assign(n, footing_.weight / footing_.density);
        for (std::size_t i = 0; i < n; ++i)
        {
            const double below    = footing_.depth * footing_.width - position[2 * n + i];
            const double vertical = -footing_.surcharge - footing_.weight * below;
            stress[i] = stress[n + i] = sideways * vertical;
            stress[2 * n + i]         = vertical;
            if (below < row) { pull_[id[i]] += footing_.surcharge / (row * footing_.density); }
        }
        points.stress.assign(stress);
    }

    void pull(double dt)
    {
        auto&      points   = experiment_.simulation().sand().points();
        const auto id       = points.id.to_host();
        auto       velocity = points.velocity.to_host();
        for (std::size_t i = 0; i < id.size(); ++i) { velocity[2 * id.size() + i] -= pull_[id[i]] * dt; }
        points.velocity.assign(velocity);
    }

    Footing             footing_;
    TemporaryDirectory  folder_;
    Experiment<Exec>    experiment_;
    std::vector<double> pull_; ///< m/s2 downwards, by point id
};

inline void print(const std::string& what, const Footing& footing, const std::vector<FootingLoad>& loads)
{
    std::cout << "  " << what << ", " << footing.volume_strain << ", B/" << 2 * footing.cells
              << ", settlement / B: pressure in Pa:";
    for (const auto& load : loads) { std::cout << " " << load.settlement << ": " << load.pressure; }
    std::cout << std::endl;
}

inline double mean_pressure(const std::vector<FootingLoad>& loads, std::size_t first, std::size_t end)
{
    double sum = 0;
    for (std::size_t i = first; i < end; ++i) { sum += loads[i].pressure; }
    return sum / static_cast<double>(end - first);
}

/// Mean pressure, Pa, over a quarter of the settlement, within which waves average out.
inline double last_quarter(const std::vector<FootingLoad>& loads)
{
    return mean_pressure(loads, 3 * loads.size() / 4, loads.size());
}
inline double third_quarter(const std::vector<FootingLoad>& loads)
{
    return mean_pressure(loads, loads.size() / 2, 3 * loads.size() / 4);
}

/// Extrapolates figures at two numbers of cells across B to infinitely many, with a first-order error: grid and points
/// resolve the footing's edge to a cell, so that its width is B + O(h).
inline double at_infinitely_many(int coarse, double coarse_value, int fine, double fine_value)
{
    return (fine * fine_value - coarse * coarse_value) / (fine - coarse);
}

} // namespace tread::test
