#include "world/bearing.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

// Closed forms that predict the contact patch of a body at rest.
namespace
{

using namespace tread;
using namespace tread::world;

scene::Material soil(double friction, double cohesion, double density)
{
    scene::Material sand;
    sand.model              = scene::MaterialModel::mohr_coulomb;
    sand.density            = density;
    sand.friction_angle_deg = friction;
    sand.cohesion           = cohesion;
    return sand;
}

TEST(Bearing, FactorsAreThoseOfTheTables)
{
    EXPECT_NEAR(bearing_factors(0).cohesion, 5.142, 1e-3); // Prandtl
    EXPECT_EQ(bearing_factors(0).surcharge, 1);
    EXPECT_EQ(bearing_factors(0).weight, 0);
    EXPECT_NEAR(bearing_factors(30).cohesion, 30.14, 0.01);
    EXPECT_NEAR(bearing_factors(30).surcharge, 18.40, 0.01);
    EXPECT_NEAR(bearing_factors(30).weight, 15.07, 0.01); // Hansen
}

/// On weightless clay the load is (2 + pi) c times the area of the chord.
TEST(Bearing, CarriesAWheelOnClay)
{
    const RoundBody wheel{0.245, 0.2, 1000};
    const Patch     patch  = bearing_patch(soil(0, 5000, 0), 9.8, wheel);
    const double    length = 1000 / ((2 + std::numbers::pi) * 5000 * 0.2);
    EXPECT_TRUE(patch.carried);
    EXPECT_NEAR(patch.length, length, 1e-9);
    EXPECT_NEAR(patch.sinkage, 0.245 - std::sqrt(0.245 * 0.245 - 0.25 * length * length), 1e-9);
    EXPECT_EQ(patch.width, 0.2);
}

/// The wheel of configs/paper/slip_sand.toml, for which its comment gives 28 to 38 mm.
TEST(Bearing, CarriesTheWheelOfThePaper)
{
    const Patch patch = bearing_patch(soil(29, 0, 1100), 3.72, {0.26, 0.33, 635.5});
    EXPECT_TRUE(patch.carried);
    EXPECT_NEAR(patch.sinkage, 0.0285, 0.0005);
}

TEST(Bearing, SaysWhereNothingCarries)
{
    const Patch patch = bearing_patch(soil(10, 0, 1600), 9.8, {0.15, 0.1, 1e5});
    EXPECT_FALSE(patch.carried);
    EXPECT_EQ(patch.sinkage, 0.15);
}

TEST(Bearing, ElasticGroundFollowsHertz)
{
    scene::Material ground;
    ground.young      = 1e7;
    ground.poisson    = 0.3;
    const double star = 1e7 / 0.91;
    const Patch  ball = hertz_patch(ground, {0.1, 0, 50});
    EXPECT_NEAR(ball.sinkage, std::pow(std::pow(0.75 * 50 / star, 2) / 0.1, 1.0 / 3), 1e-12);
    EXPECT_NEAR(ball.area(), std::numbers::pi * 0.1 * ball.sinkage, 1e-12);
    const Patch wheel = hertz_patch(ground, {0.1, 0.2, 50});
    EXPECT_NEAR(0.5 * wheel.length, std::sqrt(4 * 250 * 0.1 / (std::numbers::pi * star)), 1e-12);
}

} // namespace
