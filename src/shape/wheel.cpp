#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/generators.hpp"

namespace tread::shape
{
namespace
{

constexpr double pi = 3.14159265358979323846;

/// A vertex of the profile, twice: on the cap at +width/2 and on the one at -width/2.
struct Station
{
    std::int32_t front;
    std::int32_t back;
};

/// A corner of the wall's section; a grouser may stand on the way to the next.
struct RingCorner
{
    double angle;
    bool   grouser_follows;
};

double drum_radius(const scene::WheelGenerator& g) { return g.radius - (g.grousers > 0 ? g.grouser_height : 0.0); }

void require(const std::string& origin, const char* key, double value, double least, double most)
{
    if (value >= least && value <= most) { return; }
    throw InputError(fmt::format("{}: {} = {}: accepted are {:.6g} to {:.6g}", origin, key, value, least, most));
}

void check(const scene::WheelGenerator& g, const std::string& origin)
{
    require(origin, "radius", g.radius, 1e-3, 100);
    require(origin, "width", g.width, 1e-3 * g.radius, 100);
    require(origin, "grousers", g.grousers, 0, 1000);
    if (g.grousers > 0)
    {
        require(origin, "grouser_height", g.grouser_height, 1e-3 * g.radius, 0.5 * g.radius);
        const double pitch = 2 * drum_radius(g) * std::sin(pi / std::max(g.grousers, 2));
        require(origin, "grouser_width", g.grouser_width, 1e-3 * g.radius, 0.9 * pitch);
    }
    require(origin, "wall_thickness", g.wall_thickness, 1e-3 * g.radius, 0.95 * drum_radius(g));
}

std::vector<RingCorner> ring_corners(const scene::WheelGenerator& g)
{
    // Chords of at most 2 degrees stay within 0.02 % of the radius.
    constexpr double        longest = pi / 90;
    std::vector<RingCorner> ring;
    const int               pitches = std::max(g.grousers, 1);
    const double            foot    = g.grousers > 0 ? 2 * std::asin(0.5 * g.grouser_width / drum_radius(g)) : 0.0;
    const double            gap     = 2 * pi / pitches - foot;
    const int               chords  = static_cast<int>(std::ceil(gap / longest));
    for (int pitch = 0; pitch < pitches; ++pitch)
    {
        const double start = 2 * pi * pitch / pitches;
        if (g.grousers > 0) { ring.push_back({start - 0.5 * foot, true}); }
        for (int chord = 0; chord < chords; ++chord)
        {
            ring.push_back({start + 0.5 * foot + gap * chord / chords, false});
        }
    }
    return ring;
}

class WheelBuilder
{
public:
    explicit WheelBuilder(const scene::WheelGenerator& generator)
        : generator_(generator)
    {
        const std::vector<RingCorner> ring = ring_corners(generator);
        std::vector<Station>          outer, inner;
        for (const RingCorner& ring_corner : ring)
        {
            outer.push_back(on_circle(drum_radius(generator), ring_corner.angle));
            inner.push_back(on_circle(drum_radius(generator) - generator.wall_thickness, ring_corner.angle));
        }
        for (std::size_t i = 0; i < ring.size(); ++i)
        {
            const std::size_t next = (i + 1) % ring.size();
            caps(outer[i], outer[next], inner[next], inner[i]);
            side(inner[next], inner[i]);
            if (ring[i].grouser_follows) { grouser(outer[i], outer[next]); }
            else { side(outer[i], outer[next]); }
        }
    }

    TriangleMesh mesh;

private:
    /// The profile lies in the z-x plane and turns from z to x, which is counter-clockwise seen from +y.
    Station station(double z, double x)
    {
        const auto first = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.emplace_back(x, 0.5 * generator_.width, z);
        mesh.vertices.emplace_back(x, -0.5 * generator_.width, z);
        return {first, first + 1};
    }

    Station on_circle(double radius, double angle)
    {
        return station(radius * std::cos(angle), radius * std::sin(angle));
    }

    /// Tip corner above a foot corner: moved along the grouser's middle line to the outer radius.
    Station above(const Station& foot, const Eigen::Vector3d& outwards)
    {
        const Eigen::Vector3d corner = mesh.vertices[static_cast<std::size_t>(foot.front)];
        const Eigen::Vector3d flat(corner.x(), 0, corner.z());
        const double          height = flat.dot(outwards);
        const double          across = flat.squaredNorm() - height * height;
        const double          tip    = std::sqrt(generator_.radius * generator_.radius - across);
        const Eigen::Vector3d moved  = flat + (tip - height) * outwards;
        return station(moved.z(), moved.x());
    }

    void grouser(const Station& left, const Station& right)
    {
        Eigen::Vector3d outwards =
            mesh.vertices[static_cast<std::size_t>(left.front)] + mesh.vertices[static_cast<std::size_t>(right.front)];
        outwards.y() = 0;
        outwards.normalize();
        const Station left_tip = above(left, outwards), right_tip = above(right, outwards);
        caps(left, left_tip, right_tip, right);
        side(left, left_tip);
        side(left_tip, right_tip);
        side(right_tip, right);
    }

    /// Surface over the side a-b of the profile, which has its inside on the left.
    void side(const Station& a, const Station& b)
    {
        mesh.triangles.push_back({a.front, a.back, b.back});
        mesh.triangles.push_back({a.front, b.back, b.front});
    }

    /// Both caps over a quadrangle of the profile, counter-clockwise seen from +y.
    void caps(const Station& a, const Station& b, const Station& c, const Station& d)
    {
        mesh.triangles.push_back({a.front, b.front, c.front});
        mesh.triangles.push_back({a.front, c.front, d.front});
        mesh.triangles.push_back({a.back, c.back, b.back});
        mesh.triangles.push_back({a.back, d.back, c.back});
    }

    scene::WheelGenerator generator_;
};

} // namespace

TriangleMesh wheel_mesh(const scene::WheelGenerator& generator, const std::string& origin)
{
    check(generator, origin);
    return WheelBuilder(generator).mesh;
}

} // namespace tread::shape
