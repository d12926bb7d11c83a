#include "world/push_out.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.hpp"

namespace tread::world
{
namespace
{

constexpr int    sweeps         = 24;     ///< per descent, each moving off the body with the deepest contact
constexpr int    starts         = 64;     ///< descents, from places around the point
constexpr double beyond_contact = 1.0001; ///< push over the missing distance, as gradients are inexact
constexpr double off_the_walls  = 0.25;   ///< least distance from the domain's faces, in point sides

/// The deepest contact of a point at x with a body.
struct Deepest
{
    double       missing = 0; ///< m, contact radius minus distance; 0 = no body is in reach
    std::size_t  body    = 0;
    Vec3<double> at      = Vec3<double>::Zero(); ///< m, the point's centre or one of its samples
};

Deepest deepest(const Surroundings& near, const Vec3<double>& x, double radius)
{
    Deepest found;
    near.grid.any_near(x, near.reach.search(radius),
                       [&](std::size_t body)
                       {
                           const NearestPlace place   = nearest_place(near.world, near.reach, body, x, radius);
                           const double       missing = radius - place.distance;
                           // Bodies may be visited twice, and in any order: ties go to the lowest index.
                           if (missing > found.missing ||
                               (missing == found.missing && missing > 0 && body < found.body))
                           {
                               found = {missing, body, place.at};
                           }
                           return false;
                       });
    return found;
}

/// Unit vector away from the surface; a random one where the field has no gradient.
Vec3<double> outwards(const World& world, std::size_t body, const Vec3<double>& x, Random& random)
{
    const double step = 0.02 * world.bodies.radius[body];
    Vec3<double> gradient;
    for (int c = 0; c < 3; ++c)
    {
        const Vec3<double> aside = step * Vec3<double>::Unit(c);
        gradient[c]              = distance(world, body, x + aside) - distance(world, body, x - aside);
    }
    if (gradient.norm() > 1e-3 * step) { return gradient.normalized(); }
    const double height = random.uniform(-1, 1), turn = random.uniform(0, 2 * std::numbers::pi);
    const double across = std::sqrt(1 - height * height);
    return {across * std::cos(turn), across * std::sin(turn), height};
}

class Search
{
public:
    Search(const Surroundings& near, const SandPoint& point)
        : near_(near)
        , origin_(point.position)
        , table_(point.kind.terrain)
        , radius_(near.reach.radius(point.kind.volume))
        , margin_(off_the_walls * std::cbrt(point.kind.volume))
        , random_(0x5eed0f5a7dull + point.id)
    {
    }

    std::optional<Vec3<double>> run()
    {
        if (auto place = descend(origin_)) { return place; }
        for (int start = 1; start <= starts; ++start)
        {
            const double       way    = near_.farthest * double(start) / starts;
            const double       height = random_.uniform(-1, 1), turn = random_.uniform(0, 2 * std::numbers::pi);
            const double       across = std::sqrt(1 - height * height);
            const Vec3<double> x =
                origin_ + way * Vec3<double>(across * std::cos(turn), across * std::sin(turn), height);
            if (!allowed(x)) { continue; }
            if (auto place = descend(x)) { return place; }
        }
        return {};
    }

private:
    /// Whether the domain and the sand allow the point there.
    bool allowed(const Vec3<double>& x) const
    {
        if (!((x - origin_).squaredNorm() <= near_.farthest * near_.farthest)) { return false; }
        for (int c = 0; c < 3; ++c)
        {
            if (x[c] < margin_ || x[c] > near_.world.geometry.size[c] - margin_) { return false; }
        }
        return near_.sand.holds(table_, x);
    }

    std::optional<Vec3<double>> descend(Vec3<double> x)
    {
        for (int sweep = 0; sweep < sweeps; ++sweep)
        {
            const Deepest body = deepest(near_, x, radius_);
            if (!(body.missing > 0)) { return allowed(x) ? std::optional(x) : std::nullopt; }
            x += beyond_contact * body.missing * outwards(near_.world, body.body, body.at, random_);
            if ((x - origin_).squaredNorm() > near_.farthest * near_.farthest) { return {}; }
        }
        return {};
    }

    const Surroundings& near_;
    Vec3<double>        origin_;
    std::int32_t        table_;
    double              radius_; ///< m, contact radius
    double              margin_; ///< m
    Random              random_;
};

} // namespace

std::optional<Vec3<double>> free_place(const Surroundings& near, const SandPoint& point)
{
    return Search(near, point).run();
}

} // namespace tread::world
