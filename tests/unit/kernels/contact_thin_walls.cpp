#include "contact_places.hpp"

#include <cstdio>

// Walls that are thinner than a point's sphere: a point that is driven past the middle of a wall leaves at the side
// where it came in.
namespace tread::test
{
namespace
{

const double half_wall = 0.5 * radius; ///< m
const double breadth   = 8 * radius;   ///< m, half of it

/// Even numbers of nodes across the wall leave its middle plane within a cell, where grad phi vanishes; a node in it
/// would give the plane to one face. Fine: a cell is an eighth of the wall; coarse: half of it, and all of the inside
/// beyond a quarter is flat.
constexpr int fine = 144, coarse = 36;

AnalyticShape wall(int cells) { return box_shape({half_wall, breadth, breadth}, 10 * radius, cells); }

/// A wall that is turned and moves with 1 m/s.
BodyState moving_wall()
{
    BodyState wall{Vec3<double>::Constant(0.5)};
    wall.orientation = Quat(Eigen::AngleAxisd(0.5, Vec3<double>(1, 2, 3).normalized()));
    wall.velocity    = Vec3<double>(1, 0, 0);
    return wall;
}

/// A frictionless or rough wall that is hit at `from` (m, its own frame) by a point of this speed relative to it (m/s).
struct Shot
{
    BodyState    body;
    Vec3<double> from;
    double       speed;
    double       friction;
    int          cells = fine;
};

/// What became of the point, in the wall's frame.
struct Outcome
{
    double              deepest; ///< m past the middle along its way; negative before it
    double              speed;   ///< m/s, with which it leaves against its way
    double              energy;  ///< kinetic energy at the end over that at the start
    contact::Tangential record;  ///< at its deepest place
};

template<class Case>
class ContactThinWalls : public ContactTest<Case>
{
protected:
    Outcome outcome(const Shot& shot)
    {
        SceneNumbers numbers;
        numbers.pair.friction   = shot.friction;
        const Vec3<double> way  = -(shot.body.orientation * shot.from.normalized());
        const PointState   sand = {shot.body.position + shot.body.orientation * shot.from,
                                   shot.body.velocity + shot.speed * way};

        typename ContactTest<Case>::Scene scene(this->exec(), {wall(shot.cells)}, {shot.body}, {sand}, numbers);
        const double                      dt = 2.5e-6;
        Outcome                           found{-1, 0, 0, contact::no_tangential()};
        Vec3<double>                      at = shot.body.position, v = Vec3<double>::Zero();
        scene.begin();
        for (int i = 0; i < 1200; ++i)
        {
            scene.substep(dt);
            at += dt * shot.body.velocity;
            scene.bodies.position.assign({at});
            v                 = scene.contact.velocity.to_host()[0] - shot.body.velocity;
            const double past = (scene.contact.position.to_host()[0] - at).dot(way);
            if (past <= found.deepest) { continue; }
            found.deepest = past;
            found.record  = scene.contact.tangential.to_host()[0];
        }
        found.speed  = -v.dot(way);
        found.energy = v.squaredNorm() / (shot.speed * shot.speed);
        return found;
    }
};

TYPED_TEST_SUITE(ContactThinWalls, ContactCases, ContactCaseNames);

/// The normal force has one potential while the point sees one side. Where it begins and ceases to be pushed to the
/// side where it came in, the interpolated distance is off by the rounding of its ridge, at most a tenth of the wall on
/// these nodes, on the way in and out alike: 2 % of the energy may differ.
constexpr double least_energy = 0.98;

TYPED_TEST(ContactThinWalls, APointLeavesAtTheSideWhereItCameIn)
{
    const Vec3<double> face(radius + half_wall + 1e-4, 3e-4, 2e-4);
    BodyState          still{Vec3<double>::Constant(0.5)};
    for (const BodyState& body : {still, moving_wall()})
    {
        for (const double side : {1.0, -1.0})
        {
            const Outcome end = this->outcome({body, side * face, 11, 0});
            std::printf(
                "[ measured ] %.2f of the half wall past its middle, leaves with %.3f of its speed, energy %.4f, "
                "at least %.2f\n",
                end.deepest / half_wall, end.speed / 11, end.energy, least_energy);
            EXPECT_GT(end.deepest, 0.2 * half_wall) << "the test does not reach the middle";
            EXPECT_GT(end.speed, 0.95 * 11);
            EXPECT_GE(end.energy, least_energy);
            EXPECT_LE(end.energy, 2 - least_energy);
        }
    }
}

TYPED_TEST(ContactThinWalls, SidesAreKeptOnCoarseFields)
{
    const BodyState    still{Vec3<double>::Constant(0.5)};
    const Vec3<double> face(radius + half_wall + 1e-4, 3e-4, 2e-4), edge(1e-5, breadth + radius + 1e-4, 0);
    for (const Vec3<double>& from : {face, edge})
    {
        const Outcome end = this->outcome({still, from, 11, 0, coarse});
        std::printf("[ measured ] leaves with %.3f of its speed, energy %.4f, at least %.2f\n", end.speed / 11,
                    end.energy, least_energy);
        EXPECT_GT(end.speed, 0.95 * 11);
        EXPECT_GE(end.energy, least_energy);
        EXPECT_LE(end.energy, 2 - least_energy);
    }
}

/// A blade's edge: behind it both faces are as near as each other.
TYPED_TEST(ContactThinWalls, APointLeavesAtTheEdgeWhereItCameIn)
{
    BodyState     still{Vec3<double>::Constant(0.5)};
    const Outcome end    = this->outcome({still, Vec3<double>(0.02 * half_wall, breadth + radius + 1e-4, 0), 11, 0});
    const double  inside = end.deepest + breadth;
    std::printf(
        "[ measured ] %.2f of the half wall inside, leaves with %.3f of its speed, energy %.4f, at least %.2f\n",
        inside / half_wall, end.speed / 11, end.energy, least_energy);
    EXPECT_GT(inside, half_wall) << "the test does not reach the place where both faces are nearest";
    EXPECT_GT(end.speed, 0.95 * 11);
    EXPECT_GE(end.energy, least_energy);
}

/// Friction takes energy, never gives it, and has its own record of the side.
TYPED_TEST(ContactThinWalls, ARoughWallKeepsItsSides)
{
    BodyState          still{Vec3<double>::Constant(0.5)};
    const Vec3<double> oblique(radius + half_wall + 1e-4, 0.3 * radius, 0);
    const Outcome      end = this->outcome({still, oblique, 11.5, 0.3});
    std::printf(
        "[ measured ] %.2f of the half wall past its middle, leaves with %.3f of its speed, energy %.4f, at most "
        "1\n",
        end.deepest / half_wall, end.speed / 11.5, end.energy);
    EXPECT_GT(end.deepest, 0) << "the test does not reach the middle";
    EXPECT_GT(end.speed, 0);
    EXPECT_LE(end.energy, 1);
    EXPECT_GT(end.record.normal.dot(oblique), 0);
}

/// Without friction, too: a coarse field of a thin wall has no clear normal left once a point is inside.
TYPED_TEST(ContactThinWalls, FrictionlessContactsHaveRecordsOfTheirSide)
{
    SceneNumbers numbers;
    numbers.pair.friction = 0;
    const BodyState             still{Vec3<double>::Constant(0.5)};
    const Vec3<double>          touching(half_wall + 0.5 * radius, 0, 0);
    typename TestFixture::Scene scene(this->exec(), {wall(fine)}, {still}, {{still.position + touching}}, numbers);
    scene.begin();
    scene.substep(1e-6);
    const auto records = scene.records();
    ASSERT_EQ(records.size(), 1U);
    EXPECT_GT(records[0].tangential.normal[0], 0.99);
    EXPECT_EQ(records[0].tangential.force.norm(), 0);
}

} // namespace
} // namespace tread::test
