#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "dem_ray_shapes.hpp"
#include "shape/distance/mesh_distance.hpp"
#include "shape/generators/generators.hpp"
#include "shape/mesh/triangle.hpp"

// Narrow phase by rays: single rays compared with all triangles, spheres with Hertz, impacts with distance fields.
namespace tread::test
{
namespace dem_rays_test
{

Vec3<double> random_vector(Random& random)
{
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// First triangle hit, from the sides of its corners as seen along the ray; -1 if none.
struct BruteHit
{
    double length   = 1e9;
    int    triangle = -1;
};

BruteHit brute_force(const shape::TriangleMesh& mesh, const Vec3<double>& origin, const Vec3<double>& direction)
{
    BruteHit hit;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const shape::Corners at     = shape::corners(mesh, t);
        const Vec3<double>   normal = shape::area_vector(mesh, t);
        const double         length = normal.dot(at[0] - origin) / normal.dot(direction);
        const Vec3<double>   place  = origin + length * direction;
        bool                 within = length > 0 && length < hit.length;
        for (std::size_t c = 0; c < 3; ++c)
        {
            within = within && normal.cross(at[(c + 1) % 3] - at[c]).dot(place - at[c]) >= 0;
        }
        if (within) { hit = {length, static_cast<int>(t)}; }
    }
    return hit;
}

TEST(RayHits, AreTheFirstOfAllTriangles)
{
    const shape::ShapeTemplate form = dented_rock(162, 16);
    const dem::RayShape        rays = rays_of(form.mesh, form.nodes.positions);
    const shape::MeshDistance  mesh = shape::prepare_distance(form.mesh);
    Random                     random(3);
    int                        inside = 0, passing = 0;
    for (int ray = 0; ray < 2000; ++ray)
    {
        const Vec3<double> origin = 0.6 * random_vector(random), direction = random_vector(random).normalized();
        const dem::RayHit  found    = first_hit(rays.view(), origin, direction, 1e9);
        const BruteHit     expected = brute_force(form.mesh, origin, direction);
        EXPECT_EQ(found.triangle < 0, expected.triangle < 0);
        EXPECT_EQ(found.cosine > 0, shape::signed_distance(mesh, origin) < 0);
        if (found.cosine > 0) { ++inside; }
        if (found.triangle < 0)
        {
            ++passing;
            continue;
        }
        EXPECT_NEAR(found.length, expected.length, 1e-12);
        const Vec3<double> normal =
            shape::area_vector(form.mesh, static_cast<std::size_t>(expected.triangle)).normalized();
        EXPECT_NEAR(found.cosine, normal.dot(direction), 1e-6);
        EXPECT_LT(first_hit(rays.view(), origin, direction, 0.999 * found.length).triangle, 0);
    }
    std::printf("2000 rays about a dented rock: %d from inside, %d meet nothing\n", inside, passing);
    EXPECT_GT(inside, 200);
    EXPECT_GT(passing, 200);
}

TEST(RayHits, AreNotLostBetweenTriangles)
{
    const shape::ShapeTemplate form = dented_rock(162, 16);
    const dem::RayShape        rays = rays_of(form.mesh, form.nodes.positions);
    const auto                 hits = [&](const Vec3<double>& to)
    {
        // The rock is star-shaped about a point, but not about the origin: anything in between is nearer.
        const dem::RayHit hit = first_hit(rays.view(), Vec3<double>::Zero(), to.normalized(), 1e9);
        EXPECT_GT(hit.cosine, 0);
        EXPECT_LT(hit.length, to.norm() + 1e-9);
    };
    for (const Vec3<double>& vertex : form.mesh.vertices) { hits(vertex); }
    for (std::size_t t = 0; t < form.mesh.triangles.size(); ++t)
    {
        const shape::Corners at = shape::corners(form.mesh, t);
        for (std::size_t c = 0; c < 3; ++c) { hits(0.5 * (at[c] + at[(c + 1) % 3])); }
    }
}

/// Cube of edge 2 m, its faces along the axes.
shape::TriangleMesh cube_mesh()
{
    shape::TriangleMesh cube;
    for (int i = 0; i < 8; ++i) { cube.vertices.emplace_back(2 * (i & 1) - 1, (i & 2) - 1, (i & 4) / 2 - 1); }
    cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return cube;
}

TEST(RayHits, MayRunAlongTheAxesAndTheBoxes)
{
    const dem::RayShape rays = rays_of(cube_mesh(), {});
    for (int place = 0; place < 125; ++place)
    {
        const int          row = place / 5, layer = place / 25;
        const Vec3<double> origin = 0.25 * Vec3<double>(place % 5 - 2, row % 5 - 2, layer - 2);
        for (int way = 0; way < 6; ++way)
        {
            const int          axis = way % 3, sign = way < 3 ? 1 : -1;
            const Vec3<double> along = sign * Vec3<double>::Unit(axis);
            const dem::RayHit  hit   = first_hit(rays.view(), origin, along, 1e9);
            EXPECT_NEAR(hit.length, 1 - sign * origin[axis], 1e-15);
            EXPECT_EQ(hit.cosine, 1);
        }
    }
}

TEST(RayShapes, NormalsAreMeansWhereTrianglesMeetAndRaysEndHalfWay)
{
    const double                    third = 1 / std::sqrt(3.0), half = 1 / std::sqrt(2.0);
    const dem::RayShape             rays    = rays_of(cube_mesh(), {{1, 0.3, -0.2}, {1, 1, 0.1}, {1, 1, 1}, {1, 0, 0}});
    const std::vector<double>       ways    = {2, 2 / half, 2 / third, 2};
    const std::vector<Vec3<double>> normals = {{1, 0, 0}, {half, half, 0}, {third, third, third}, {1, 0, 0}};
    for (std::size_t i = 0; i < ways.size(); ++i)
    {
        EXPECT_LT((rays.inward[i] + normals[i]).norm(), 1e-12) << i;
        EXPECT_NEAR(rays.length[i], 0.5 * ways[i], 1e-6) << i;
    }
}

template<class Exec>
class RayContact : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(RayContact, Backends, BackendNames);

constexpr double radius = 0.2, density = 2000;

struct ForceAndEnergy
{
    double force, energy;
};

/// The law by rays on two exact spheres at a centre distance of 2 R - approach, by quadrature over one of them: a ray
/// at an angle a from the axis exits at R - (D cos a - sqrt(R^2 - D^2 sin^2 a)).
ForceAndEnergy exact_spheres(double approach, double linear_overlap)
{
    const dem::PairLaw law      = dem::pair_law(properties(1e7, 0.3, 2, 0, 0), {1.0, linear_overlap}, 2 / radius, 1.0);
    const double       distance = 2 * radius - approach, edge = std::acos(0.5 * distance / radius);
    constexpr int      rings = 2000;
    ForceAndEnergy     sum{0, 0};
    for (int i = 0; i < rings; ++i)
    {
        const double angle     = (i + 0.5) / rings * edge;
        const double aside     = distance * std::sin(angle);
        const double root      = std::sqrt(radius * radius - aside * aside);
        const double reach     = distance * std::cos(angle) - root; // of the exit, from the centre of the node's sphere
        const double normal    = (distance - reach * std::cos(angle)) / radius;
        const double area      = 2 * std::numbers::pi * radius * radius * std::sin(angle) * edge / rings;
        const dem::Traction at = dem::traction_at(law, radius - reach);
        sum.force += at.pressure * area * normal / (root / radius);
        sum.energy += at.energy * area;
    }
    return sum;
}

/// Largest force in a head-on impact of two spheres, each at `speed`, when all kinetic energy is in the contact.
double exact_largest_force(double speed, double linear_overlap)
{
    const double energy = solid_sphere(radius, density, Vec3<double>::Zero()).mass * speed * speed;
    double       low = 0, high = radius;
    for (int bisection = 0; bisection < 60; ++bisection)
    {
        const double middle                                                  = 0.5 * (low + high);
        (exact_spheres(middle, linear_overlap).energy < energy ? low : high) = middle;
    }
    return exact_spheres(low, linear_overlap).force;
}

TYPED_TEST(RayContact, HeadOnSpheresApproachHertzWithTheirNodes)
{
    constexpr double hertz = 7593.4; // F_max, docs/verification.md#hertz-impact
    constexpr int    turns = 12;
    const double     limit = exact_largest_force(1, 1e-3);
    // Rays exit obliquely: the deviation from Hertz's paraboloids is proportional to the overlap, which is 11 % of R
    // here and 0.01^0.8 of that at a hundredth of the speed, where forces scale with v^1.2.
    const double slow = exact_largest_force(0.01, 1e-6) / std::pow(0.01, 1.2);
    std::printf("Hertz %.1f N, rays on exact spheres %.1f N (%+.2f %%), slow %.1f N (%+.2f %%, tolerance 0.3 %%)\n",
                hertz, limit, 100 * (limit / hertz - 1), slow, 100 * (slow / hertz - 1));
    EXPECT_NEAR(slow, hertz, 0.003 * hertz);
    const shape::TriangleMesh mesh = shape::icosphere(2562, "test");
    for (const auto& [level, tolerance] : {std::pair{2, 0.03}, std::pair{3, 0.01}})
    {
        const SolidShape      sphere = unit_sphere(level, 64);
        const Rays<TypeParam> rays(this->exec(), rays_of(mesh, sphere.positions));
        const Vec3<double>    direction = Vec3<double>(0.3, -0.5, 0.8).normalized();
        Random                random(11);
        double                mean = 0, low = 1e9, high = 0, energy = 0;
        for (int turn = 0; turn < turns; ++turn)
        {
            std::vector<Solid> solids(2, solid_sphere(radius, density, -1.001 * radius * direction));
            solids[1].position = -solids[0].position;
            solids[0].velocity = direction;
            solids[1].velocity = -direction;
            for (Solid& solid : solids) { solid.orientation = random_turn(random); }
            typename TestFixture::Scene scene(this->exec(), {sphere}, solids, {});
            scene.rays             = rays.views();
            const RockImpact found = impact_of(scene, 2e-5, 0.04); // the contact lasts 32.5 ms (A1)
            mean += found.force / turns;
            low    = std::min(low, found.force);
            high   = std::max(high, found.force);
            energy = std::max(energy, std::abs(found.energy));
            EXPECT_LT(std::abs(found.energy), 1e-4); // a potential; dt is a 1600th of the contact
            EXPECT_LT(found.momentum, 1e-10);
        }
        std::printf("%zu nodes: mean F_max of %d orientations %.1f N (%.0f to %.0f), expected %.1f N: %+.2f %%, "
                    "tolerance %.0f %% (3 standard errors); energy changes by up to %.1e\n",
                    sphere.positions.size(), turns, mean, low, high, limit, 100 * (mean / limit - 1), 100 * tolerance,
                    energy);
        EXPECT_NEAR(mean, limit, tolerance * limit);
    }
}

/// Two dented rocks of 0.2 m that just overlap, or not.
std::vector<Solid> fast_rocks(const shape::ShapeTemplate& form, Random& random)
{
    std::vector<Solid> rocks(2, rock_solid(form));
    for (Solid& rock : rocks)
    {
        rock.orientation = random_turn(random);
        rock.velocity    = 3 * random_vector(random);
        rock.spin        = 20 * random_vector(random);
    }
    rocks[1].position = random.uniform(0.15, 0.22) * random_vector(random).normalized();
    return rocks;
}

TYPED_TEST(RayContact, NoNodeIsMissedByTheList)
{
    // The grid is coarse: the interpolated surface, which selects the nodes, is centimetres off the mesh.
    const shape::ShapeTemplate form = dented_rock(642, 8);
    const SolidShape           rock = solid_of(form);
    const Rays<TypeParam>      rays(this->exec(), rays_of(form.mesh, form.nodes.positions));
    Random                     random(3);
    int                        touching = 0;
    std::int64_t               listed = 0, all = 0;
    double                     worst = 0;
    for (int trial = 0; trial < 400; ++trial)
    {
        const double                dt = trial % 2 == 0 ? 1e-6 : 5e-4; // s: at rest, or a displacement of 2 mm
        typename TestFixture::Scene scene(this->exec(), {rock}, fast_rocks(form, random), {});
        scene.rays = rays.views();
        scene.find(dt);
        scene.move(dt);
        scene.contact(dt);
        const auto from_list = scene.bodies.force.to_host();
        listed += scene.pairs.nodes.node.size();
        scene.find(10); // all nodes
        scene.contact(dt);
        const auto from_all = scene.bodies.force.to_host();
        all += scene.pairs.nodes.node.size();
        touching += from_all[0].norm() > 0;
        worst = std::max(worst, (from_list[0] - from_all[0]).norm() / std::max(from_all[0].norm(), 1.0));
    }
    std::printf("%d of 400 pairs in contact; forces from %lld listed of %lld nodes differ by %.1e, tolerance 1e-12 "
                "(order of the sums)\n",
                touching, static_cast<long long>(listed), static_cast<long long>(all), worst);
    EXPECT_GT(touching, 100);
    EXPECT_LT(2 * listed, all);
    EXPECT_LT(worst, 1e-12);
}

TYPED_TEST(RayContact, OffCentreImpactOfDentedRocks)
{
    for (const int nodes : {162, 642})
    {
        const shape::ShapeTemplate form  = dented_rock(nodes, 64);
        const SolidShape           solid = solid_of(form);
        const Rays<TypeParam>      rays(this->exec(), rays_of(form.mesh, form.nodes.positions));
        for (const dem::RayView* view : {static_cast<const dem::RayView*>(nullptr), rays.views()})
        {
            Random        random(7);
            double        square = 0, largest = 0, force = 0;
            constexpr int turns = 3;
            for (int turn = 0; turn < turns; ++turn)
            {
                typename TestFixture::Scene scene(this->exec(), {solid}, off_centre_rocks(form, random), {});
                scene.rays             = view;
                const RockImpact found = impact_of(scene, 1e-5, 0.14);
                square += found.energy * found.energy / turns;
                largest = std::max(largest, std::abs(found.energy));
                force += found.force / turns;
                EXPECT_LT(found.momentum, 1e-11); // rounding
                EXPECT_LT(found.spin, 1e-11);
                EXPECT_GT(found.exchange, 0.1);
            }
            // Oblique rays and jumps of rays dissipate some energy: less than the mean over vertices, 1.2e-1 rms.
            if (view != nullptr) { EXPECT_LT(std::sqrt(square), 0.12); }
            std::printf("%d nodes by %s: energy changes by %.1e rms, %.1e at most; mean F_max %.1f N\n", nodes,
                        view == nullptr ? "distance field" : "rays", std::sqrt(square), largest, force);
        }
    }
}

} // namespace dem_rays_test
} // namespace tread::test
