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
    std::string soil;              ///< keys of the soil's [[material]]
    double      density   = 1000;  ///< kg/m3, of the soil
    double      gravity   = 0;     ///< m/s2, downwards
    double      width     = 0.1;   ///< m, B
    int         cells     = 5;     ///< of the grid across B / 2
    double      reach     = 2;     ///< of the soil sideways from the centre, in B
    double      depth     = 1;     ///< in B
    double      stiffness = 1.5e7; ///< Pa, confined modulus of the footing: about the soil's, for the same step
    double      speed     = 0.02; ///< m/s, after a ramp over a quarter of the time; waves carry some rho c_s times this
    double      settlement    = 0.01; ///< at the end, in B
    double      damping       = 0.3;  ///< local
    double      pic_rate      = 0.01; ///< c_p/h
    std::string volume_strain = "point";
};

/// Mean pressure under the footing, Pa, at a settlement.
struct FootingLoad
{
    double settlement; ///< in B
    double pressure;   ///< Pa
};

/// Share of the time in which the speed rises.
constexpr double footing_ramp = 0.25;

/// s
inline double duration(const Footing& footing)
{
    return footing.settlement * footing.width / (footing.speed * (1 - 0.5 * footing_ramp));
}

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
pic_rate      = {pic_rate}
[[material]]
name    = "soil"
density = {density}
{soil}
[[material]]
name    = "footing"
model   = "elastic"
density = {density}
young   = {young}
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
                       fmt::arg("across", across), fmt::arg("h", h), fmt::arg("top", deep + 8 * h),
                       fmt::arg("young", footing.stiffness), fmt::arg("gravity", footing.gravity),
                       fmt::arg("volume_strain", footing.volume_strain), fmt::arg("density", footing.density),
                       fmt::arg("soil", footing.soil), fmt::arg("deep", deep), fmt::arg("half", 0.5 * footing.width),
                       fmt::arg("lid", deep + 4 * h), fmt::arg("speed", footing.speed),
                       fmt::arg("damping", footing.damping), fmt::arg("pic_rate", footing.pic_rate),
                       fmt::arg("duration", duration(footing)));
}

/// A stiff, rough footing. Its upper half is so heavy that no load slows it, and given its speed anew in every step;
/// its lower half weighs as the soil, so that the nodes which both share do not all stick to the footing. In
/// equilibrium the load goes through every level, so that it is read off the vertical stress of a slab under the
/// surface, less what stood there at the start.
template<class Exec>
class FootingTest
{
public:
    FootingTest(const Exec& exec, const Footing& footing)
        : footing_(footing)
        , experiment_(exec, footing_scene(footing))
    {
        auto& points = experiment_.simulation().sand().points();
        auto  stress = points.stress.to_host();
        auto  mass   = points.mass.to_host();
        stride_      = mass.size();

        const auto   position = points.position.to_host();
        const double middle   = footing.depth * footing.width + footing.width / footing.cells;
        for_footing(
            [&](std::size_t i)
            {
                if (position[2 * stride_ + i] > middle) { mass[i] *= 1e4; }
                for (std::size_t c = 0; c < 6; ++c) { stress[c * stride_ + i] = 0; }
            });
        points.stress.assign(stress);
        points.mass.assign(mass);
        set_speed(0);
        at_start_ = slab_force();
    }

    /// The load, each a mean over one of `samples` equal parts of the time.
    std::vector<FootingLoad> run(int samples)
    {
        std::vector<FootingLoad> loads;
        const double             end = duration(footing_), part = end / samples;
        double                   sum = 0, settlement = 0, last = 0;
        int                      count = 0;
        experiment_.run(
            [&](double time)
            {
                const double speed = footing_.speed * std::min(1.0, time / (footing_ramp * end));
                settlement += speed * (time - last) / footing_.width;
                last = time;
                set_speed(speed);
                sum += slab_force() - at_start_;
                ++count;
                if (time < part * static_cast<double>(loads.size() + 1) - 1e-9) { return; }
                loads.push_back({settlement, 2 * sum / (count * footing_.width)});
                sum   = 0;
                count = 0;
            });
        return loads;
    }

private:
    /// The footing's points; they may have been ordered anew in memory.
    template<class F>
    void for_footing(F f)
    {
        const auto material = experiment_.simulation().sand().points().material.to_host();
        for (std::size_t i = 0; i < material.size(); ++i)
        {
            if (material[i] == 1) { f(i); }
        }
    }

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

    void set_speed(double speed)
    {
        auto& points   = experiment_.simulation().sand().points();
        auto  velocity = points.velocity.to_host();
        for_footing(
            [&](std::size_t i)
            {
                for (std::size_t c = 0; c < 3; ++c) { velocity[c * stride_ + i] = c == 2 ? -speed : 0; }
            });
        points.velocity.assign(velocity);
    }

    Footing          footing_;
    Experiment<Exec> experiment_;
    std::size_t      stride_   = 0;
    double           at_start_ = 0;
};

} // namespace tread::test
