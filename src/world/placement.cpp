#include "world/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "base/saturated.hpp"
#include "world/body_grid.hpp"
#include "world/rocks.hpp"

namespace tread::world
{
namespace
{

/// Least distance between surfaces of bodies, over the smaller one's radius of equal volume.
constexpr double clearance = 0.01;

/// Uniformly distributed rotation (Shoemake 1992).
Quat random_rotation(Random& random)
{
    const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
                 b = 2 * std::numbers::pi * random.uniform();
    return {std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
            std::sqrt(u) * std::sin(b)};
}

Vec3<double> random_place(const scene::Box& box, Random& random)
{
    const double x = random.uniform(box.low[0], box.high[0]), y = random.uniform(box.low[1], box.high[1]),
                 z = random.uniform(box.low[2], box.high[2]);
    return {x, y, z};
}

scene::Box shrunk(scene::Box box, double by)
{
    for (std::size_t c = 0; c < 3; ++c)
    {
        box.low[c] += by;
        box.high[c] -= by;
    }
    return box;
}

bool empty(const scene::Box& box)
{
    return box.low[0] > box.high[0] || box.low[1] > box.high[1] || box.low[2] > box.high[2];
}

void resize(HostBodies& bodies, std::size_t size)
{
    bodies.position.resize(size);
    bodies.orientation.resize(size, Quat::Identity());
    bodies.mass.resize(size);
    bodies.scale.resize(size);
    bodies.radius.resize(size);
    bodies.shape.resize(size);
    bodies.material.resize(size);
}

/// Adds rocks to a world one by one: the last body is a trial until it is kept.
class Placer
{
public:
    Placer(const scene::Scene& scene, std::size_t table, const Space& space, World& world)
        : space_(space)
        , box_(bounds(space.region))
        , material_(material_index(scene, scene.rocks[table].material))
        , density_(scene.materials[static_cast<std::size_t>(material_)].density)
        , world_(world)
        , grid_(world)
    {
        for (const auto& member : rocks_family(scene, table))
        {
            members_.push_back(template_index(world, member.name));
        }
        for (const auto& form : world.templates)
        {
            inscribed_.push_back(std::max(0.0, -shape::sample(form.sdf, Vec3<double>::Zero())));
        }
        for (std::size_t body = 0; body < world.bodies.size(); ++body) { grid_.add(body); }
    }

    /// Adds a trial body, without a position.
    void begin(const RockDraw& rock)
    {
        HostBodies& bodies = world_.bodies;
        body_              = bodies.size();
        resize(bodies, body_ + 1);
        const std::int32_t shape = members_[static_cast<std::size_t>(rock.member)];
        const auto&        form  = world_.templates[static_cast<std::size_t>(shape)];
        const double       scale = rock.diameter / volume_diameter(form);
        bodies.mass[body_]       = density_ * form.unit.volume * scale * scale * scale;
        bodies.scale[body_]      = scale;
        bodies.radius[body_]     = 0.5 * rock.diameter;
        bodies.shape[body_]      = shape;
        bodies.material[body_]   = material_;
        inner_                   = inscribed(body_);
        outer_                   = bounding_radius(world_, body_);
    }

    /// Box that contains all possible centres of the trial body.
    scene::Box centres() const { return shrunk(box_, inner_); }

    /// Whether the space allows the centre at x.
    bool centre_fits(const Vec3<double>& x) const
    {
        if (!contains(space_.region, x)) { return false; }
        const auto [low, high] = levels(space_, x[0], x[1]);
        return low <= x[2] - inner_ && x[2] + inner_ < high;
    }

    /// Moves the trial body; returns whether it touches nothing and lies in the space.
    bool fits(const Vec3<double>& x, const Quat& rotation)
    {
        world_.bodies.position[body_]    = x;
        world_.bodies.orientation[body_] = rotation;
        return !grid_.any_near(x, outer_, [&](std::size_t other) { return touches(other); }) && inside();
    }

    void keep() { grid_.add(body_); }
    void drop() { resize(world_.bodies, body_); }

private:
    double inscribed(std::size_t body) const
    {
        return world_.bodies.scale[body] * inscribed_[static_cast<std::size_t>(world_.bodies.shape[body])];
    }

    bool touches(std::size_t other) const
    {
        const HostBodies& bodies = world_.bodies;
        const double      gap    = (bodies.position[other] - bodies.position[body_]).norm();
        if (gap < inner_ + inscribed(other)) { return true; }
        return !apart(world_, body_, other, clearance * std::min(bodies.radius[body_], bodies.radius[other]));
    }

    bool inside() const
    {
        const Vec3<double>& x   = world_.bodies.position[body_];
        const auto&         box = space_.region.box;
        if (box && !space_.floor && !space_.height && space_.region.except.empty())
        {
            const scene::Box safe = shrunk(*box, outer_);
            if ((x.array() >= Vec3<double>(safe.low.data()).array()).all() &&
                (x.array() < Vec3<double>(safe.high.data()).array()).all())
            {
                return true;
            }
        }
        const auto&        form = template_of(world_, body_);
        const Mat3<double> turn = world_.bodies.scale[body_] * world_.bodies.orientation[body_].toRotationMatrix();
        return std::all_of(form.nodes.positions.begin(), form.nodes.positions.end(),
                           [&](const Vec3<double>& node) { return contains(space_, Vec3<double>(x + turn * node)); });
    }

    const Space&              space_;
    scene::Box                box_;
    std::int32_t              material_;
    double                    density_;
    World&                    world_;
    BodyGrid                  grid_;
    std::vector<std::int32_t> members_;   ///< templates of the family; an index past the end where no rock uses it
    std::vector<double>       inscribed_; ///< m, depth of the centre of each template
    std::size_t               body_  = 0;
    double                    inner_ = 0;
    double                    outer_ = 0;
};

/// Number of trial positions left.
struct AttemptsLeft
{
    std::int64_t for_table;
    std::int64_t for_rock = 0;
    std::int64_t outside  = 0; ///< positions outside the space, for a rock
};

bool find_place(Placer& placer, Random& random, AttemptsLeft& attempts)
{
    const scene::Box box = placer.centres();
    if (empty(box)) { return false; }
    attempts.for_rock = 50'000;
    attempts.outside  = 10'000'000;
    while (attempts.for_table > 0 && attempts.for_rock > 0 && attempts.outside > 0)
    {
        const Vec3<double> x = random_place(box, random);
        if (!placer.centre_fits(x))
        {
            --attempts.outside;
            continue;
        }
        if (placer.fits(x, random_rotation(random))) { return true; }
        --attempts.for_rock;
        --attempts.for_table;
    }
    return false;
}

/// Sites of a cubic lattice over a box, x fastest; computed on demand, as a fine lattice exceeds memory.
class Lattice
{
public:
    Lattice(const scene::Box& box, double spacing)
        : low_(box.low)
        , spacing_(spacing)
    {
        for (std::size_t c = 0; c < 3 && !empty(box); ++c)
        {
            count_[c] = std::floor((box.high[c] - box.low[c]) / spacing + 1e-9) + 1;
        }
    }

    std::size_t size() const { return static_cast<std::size_t>(saturated(count_[0] * count_[1] * count_[2])); }

    Vec3<double> operator[](std::size_t site) const
    {
        const auto        along_x = static_cast<std::size_t>(count_[0]), along_y = static_cast<std::size_t>(count_[1]);
        const std::size_t i = site % along_x, j = site / along_x % along_y, k = site / along_x / along_y;
        return {low_[0] + spacing_ * double(i), low_[1] + spacing_ * double(j), low_[2] + spacing_ * double(k)};
    }

private:
    scene::Vector3        low_;
    double                spacing_;
    std::array<double, 3> count_{};
};

bool turn_until_it_fits(Placer& placer, const Vec3<double>& site, Random& random)
{
    constexpr int turns = 20;
    for (int turn = 0; turn < turns; ++turn)
    {
        if (placer.fits(site, random_rotation(random))) { return true; }
    }
    return false;
}

/// Counts consecutive sites that do not take a rock, to bound the time on fine lattices.
struct SiteAttempts
{
    std::size_t outside = 0; ///< outside the space
    std::size_t taken   = 0; ///< occupied by other bodies

    void require_more(double diameter) const
    {
        constexpr std::size_t most_outside = 100'000'000, most_taken = 2'000'000;
        if (outside <= most_outside && taken <= most_taken) { return; }
        throw InputError(fmt::format("[[rocks]] placement: {} sites in a row do not take a rock of {:.4g} m: {} lie "
                                     "outside the space, {} touch other bodies; accepted: a region that begins where "
                                     "the rocks shall stand, or larger rocks",
                                     outside + taken, diameter, outside, taken));
    }
};

/// First site from `site` on that takes the trial rock; past the end if none does.
template<class SiteList>
std::size_t find_site(Placer& placer, const SiteList& sites, std::size_t site, double diameter, Random& random)
{
    SiteAttempts attempts;
    for (; site < sites.size(); ++site)
    {
        const Vec3<double>& x       = sites[site];
        const bool          outside = !placer.centre_fits(x);
        if (!outside && turn_until_it_fits(placer, x, random)) { break; }
        ++(outside ? attempts.outside : attempts.taken);
        attempts.require_more(diameter);
    }
    return site;
}

/// Returns the number of rocks placed.
template<class SiteList>
std::size_t place_on_sites(Placer& placer, const SiteList& sites, const std::vector<RockDraw>& rocks, Random& random)
{
    std::size_t site = 0;
    for (std::size_t rock = 0; rock < rocks.size(); ++rock)
    {
        placer.begin(rocks[rock]);
        site = find_site(placer, sites, site, rocks[rock].diameter, random);
        if (site == sites.size())
        {
            placer.drop();
            return rock;
        }
        placer.keep();
        ++site;
    }
    return rocks.size();
}

/// Sand points in the space, in a random order (Fisher and Yates).
std::vector<Vec3<double>> points_in(const Space& space, const World& world, Random& random)
{
    std::vector<Vec3<double>> sites;
    for_each_point(world.sand,
                   [&](const SandPoint& point)
                   {
                       if (contains(space, point.position)) { sites.push_back(point.position); }
                   });
    for (std::size_t left = sites.size(); left > 1; --left)
    {
        std::swap(sites[left - 1], sites[static_cast<std::size_t>(random.uniform() * static_cast<double>(left))]);
    }
    return sites;
}

double largest_bounding_diameter(const scene::Scene& scene, std::size_t table, const std::vector<RockDraw>& rocks,
                                 const World& world)
{
    std::vector<double> largest_of_member;
    for (const auto& member : rocks_family(scene, table))
    {
        const auto index = static_cast<std::size_t>(template_index(world, member.name));
        const bool drawn = index < world.templates.size();
        const auto ratio = [](const auto& form) { return 2 * form.bounding_radius / volume_diameter(form); };
        largest_of_member.push_back(drawn ? ratio(world.templates[index]) : 0);
    }
    double largest = 0;
    for (const RockDraw& rock : rocks)
    {
        largest = std::max(largest, rock.diameter * largest_of_member[static_cast<std::size_t>(rock.member)]);
    }
    return largest;
}

/// Seeds positions independently of sizes, which are drawn from the same seed.
Random random_places(const scene::Rocks& rocks) { return Random(rocks.seed ^ 0x70c5a5f0e1d2c3b4ull); }

} // namespace

std::size_t place_at_random(const scene::Scene& scene, std::size_t table, const Space& space,
                            const std::vector<RockDraw>& rocks, World& world)
{
    Placer       placer(scene, table, space, world);
    Random       random = random_places(scene.rocks[table]);
    AttemptsLeft attempts{100'000 + 1000 * static_cast<std::int64_t>(rocks.size())};
    for (std::size_t rock = 0; rock < rocks.size(); ++rock)
    {
        placer.begin(rocks[rock]);
        if (!find_place(placer, random, attempts))
        {
            placer.drop();
            return rock;
        }
        placer.keep();
    }
    return rocks.size();
}

std::size_t place_at_points(const scene::Scene& scene, std::size_t table, const Space& space,
                            const std::vector<RockDraw>& rocks, World& world)
{
    Random     random = random_places(scene.rocks[table]);
    const auto sites  = points_in(space, world, random);
    Placer     placer(scene, table, space, world);
    return place_on_sites(placer, sites, rocks, random);
}

std::size_t place_on_lattice(const scene::Scene& scene, std::size_t table, const Space& space,
                             const std::vector<RockDraw>& rocks, World& world)
{
    const double      widest   = largest_bounding_diameter(scene, table, rocks, world);
    const std::size_t before   = world.bodies.size();
    std::size_t       best     = 0;
    constexpr int     lattices = 17; // each narrower than the one before by 3 %, down to 61 %
    for (int narrowed = 0; narrowed < lattices; ++narrowed)
    {
        const double  spacing = widest * std::pow(0.97, narrowed);
        const Lattice sites(shrunk(bounds(space.region), 0.5 * spacing), spacing);
        // The narrowest lattice is tried in any case: the error message states how many rocks it takes.
        if (sites.size() < rocks.size() && narrowed + 1 < lattices) { continue; }
        Placer placer(scene, table, space, world);
        Random random = random_places(scene.rocks[table]);
        best          = std::max(best, place_on_sites(placer, sites, rocks, random));
        if (best == rocks.size()) { return best; }
        resize(world.bodies, before);
    }
    return best;
}

} // namespace tread::world
