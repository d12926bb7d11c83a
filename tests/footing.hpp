#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "physics/harness.hpp"

// Strip footing in plane strain: half of the problem beside a plane of symmetry at x = 0, one cell thick in y.
namespace tread::test
{

struct Footing
{
    std::string soil;                 ///< keys of the soil's [[material]]
    double      density       = 1000; ///< kg/m3, of the soil
    double      gravity       = 0;    ///< m/s2, downwards
    double      width         = 0.1;  ///< m, B
    int         cells         = 8;    ///< of the grid across B / 2
    double      reach         = 2.25; ///< of the soil sideways from the centre, in B
    double      depth         = 1.25; ///< in B
    double      speed         = 0.1;  ///< m/s
    double      settlement    = 0.03; ///< at the end, in B
    double      damping       = 0.3;  ///< local
    std::string volume_strain = "point";
};

/// Mean pressure under the footing, Pa, at a settlement.
struct FootingLoad
{
    double settlement; ///< in B
    double pressure;   ///< Pa
};

inline std::string footing_scene(const Footing& footing)
{
    const double h = 0.5 * footing.width / footing.cells, across = footing.reach * footing.width,
                 deep = footing.depth * footing.width;
    return fmt::format(R"(
title = "strip footing"
[domain]
size    = [{across}, {h}, {top}]
gravity = [0.0, 0.0, -{gravity}]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = {h}
[numerics]
precision     = "double"
volume_strain = "{volume_strain}"
[[material]]
name    = "soil"
density = {density}
{soil}
[[material]]
name    = "footing"
model   = "elastic"
density = {density}
young   = 1.0e6
poisson = 0.0
[[terrain]]
material = "soil"
region   = {{ box = [[0.0, 0.0, 0.0], [{across}, {h}, {deep}]] }}
[[terrain]]
material = "footing"
region   = {{ box = [[0.0, 0.0, {deep}], [{half}, {h}, {lid}]] }}
velocity = [0.0, 0.0, -{speed}]
[[phase]]
name     = "push"
damping  = {damping}
duration = {duration}
)",
                       fmt::arg("across", across), fmt::arg("h", h), fmt::arg("top", deep + 6 * h),
                       fmt::arg("gravity", footing.gravity), fmt::arg("volume_strain", footing.volume_strain),
                       fmt::arg("density", footing.density), fmt::arg("soil", footing.soil), fmt::arg("deep", deep),
                       fmt::arg("half", 0.5 * footing.width), fmt::arg("lid", deep + 2 * h),
                       fmt::arg("speed", footing.speed), fmt::arg("damping", footing.damping),
                       fmt::arg("duration", footing.settlement * footing.width / footing.speed));
}

/// A rigid, rough footing pushed down at a constant speed: its points are so heavy that nothing slows them, and keep
/// their velocity. In equilibrium the load goes through every level, so that it is read off the vertical stress of a
/// slab under the surface, less what stood there at the start.
template<class Exec>
class FootingTest
{
public:
    FootingTest(const Exec& exec, const Footing& footing)
        : footing_(footing)
        , experiment_(exec, footing_scene(footing))
    {
        auto&      points   = experiment_.simulation().sand().points();
        auto       mass     = points.mass.to_host();
        auto       stress   = points.stress.to_host();
        const auto material = points.material.to_host();
        stride_             = mass.size();
        for (std::size_t i = 0; i < mass.size(); ++i)
        {
            if (material[i] == 0) { continue; }
            mass[i] *= 1e6;
            for (std::size_t c = 0; c < 6; ++c) { stress[c * stride_ + i] = 0; }
        }
        points.mass.assign(mass);
        points.stress.assign(stress);
        at_start_ = slab_force();
    }

    /// The load at `samples` equal steps of the settlement.
    std::vector<FootingLoad> run(int samples)
    {
        std::vector<FootingLoad> loads;
        experiment_.run(
            [&](double time)
            {
                keep_velocity();
                const double settlement = footing_.speed * time / footing_.width;
                const double next       = footing_.settlement * static_cast<double>(loads.size() + 1) / samples;
                if (settlement < next - 1e-9) { return; }
                loads.push_back({settlement, 2 * (slab_force() - at_start_) / footing_.width});
            });
        return loads;
    }

    Experiment<Exec>& experiment() { return experiment_; }

private:
    /// N/m: of the half, compression positive; over the slab from a half to three quarters of the depth.
    double slab_force()
    {
        auto&        points   = experiment_.simulation().sand().points();
        const auto   position = points.position.to_host();
        const auto   stress   = points.stress.to_host();
        const auto   volume   = points.volume.to_host();
        const double deep = footing_.depth * footing_.width, low = 0.5 * deep, high = 0.75 * deep;
        const double thick = 0.5 * footing_.width / footing_.cells;
        double       force = 0;
        for (std::size_t i = 0; i < stride_; ++i)
        {
            const double z = position[2 * stride_ + i];
            if (z > low && z < high) { force -= stress[2 * stride_ + i] * volume[i]; }
        }
        return force / ((high - low) * thick);
    }

    void keep_velocity()
    {
        auto&      points   = experiment_.simulation().sand().points();
        auto       velocity = points.velocity.to_host();
        const auto material = points.material.to_host();
        for (std::size_t i = 0; i < stride_; ++i)
        {
            if (material[i] == 0) { continue; }
            for (std::size_t c = 0; c < 3; ++c) { velocity[c * stride_ + i] = c == 2 ? -footing_.speed : 0; }
        }
        points.velocity.assign(velocity);
    }

    Footing          footing_;
    Experiment<Exec> experiment_;
    std::size_t      stride_   = 0;
    double           at_start_ = 0;
};

} // namespace tread::test
