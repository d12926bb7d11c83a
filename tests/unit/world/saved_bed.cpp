#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/bed_file.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "scene_text.hpp"
#include "temporary_directory.hpp"
#include "world/packing.hpp"
#include "world/saved_bed.hpp"

namespace tread::world
{
namespace
{

std::string text(const std::string& rocks, double density = 2700, const std::string& size = "[0.4, 0.4, 0.4]")
{
    return fmt::format(R"(
title = "bed"
[domain]
size    = {}
gravity = [0.0, 0.0, -9.81]
[[material]]
name    = "rock"
model   = "elastic"
density = {:.1f}
young   = 1.0e7
poisson = 0.25
[[shape]]
name     = "ball"
generate = {{ kind = "sphere", nodes = 162 }}
sdf_cells = 32
[[shape]]
name     = "clast"
generate = {{ kind = "rock", seed = 3, nodes = 162, variants = 2 }}
sdf_cells = 32
{}
[[phase]]
name     = "rest"
duration = 1.0
)",
                       size, density, rocks);
}

std::string drawn(const std::string& shape, int count, const std::string& region = "[[0.0, 0.0, 0.0], [0.4, 0.4, 0.4]]")
{
    return fmt::format(R"([[rocks]]
shape     = "{}"
material  = "rock"
count     = {}
diameter  = 0.1
placement = "grid"
region    = {{ box = {} }}
)",
                       shape, count, region);
}

std::string from(const std::string& shape, const std::string& path)
{
    return fmt::format("[[rocks]]\nshape = \"{}\"\nmaterial = \"rock\"\nfrom = \"{}\"\n", shape, path);
}

io::BodyFields fields_of(const World& world)
{
    io::BodyFields fields;
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        const Quat& q = world.bodies.orientation[b];
        for (int c = 0; c < 3; ++c) { fields.position.push_back(world.bodies.position[b][c]); }
        for (const double value : {q.w(), q.x(), q.y(), q.z()}) { fields.orientation.push_back(value); }
        fields.scale.push_back(world.bodies.scale[b]);
        fields.shape.push_back(world.bodies.shape[b]);
    }
    return fields;
}

class SavedBed : public ::testing::Test
{
protected:
    SavedBed()
        : scene(test::load_text(text(drawn("clast", 5) + drawn("ball", 3, "[[0.0, 0.0, 0.2], [0.4, 0.4, 0.4]]"))))
        , world(build_world(scene))
    {
        const auto wall = static_cast<std::int64_t>(world.bodies.size()) + 4; // x, x, y, y, bottom
        contacts = {{dem::pair_key(1, 6), {{1, 2, 3}, {0, 0, 1}, 4, 5, 6}, dem::no_rolling(), {0.01, 0.02, 0.03}},
                    {dem::pair_key(2, wall), {{7, 8, 9}, {0, 0, 1}, 10, 11, 12}}};
        io::write_bed(path, make_bed(scene, world, fields_of(world), contacts));
    }

    std::string refusal(const std::string& scene_text) const
    {
        try
        {
            build_world(test::load_text(scene_text));
        }
        catch (const InputError& error)
        {
            return error.what();
        }
        return "accepted";
    }

    test::TemporaryDirectory   folder;
    std::string                path = folder.path("bed.h5");
    scene::Scene               scene;
    World                      world;
    std::vector<ContactRecord> contacts;
};

TEST_F(SavedBed, ComesBackAsItWas)
{
    const World again = build_world(test::load_text(text(from("clast", path) + from("ball", path))));
    ASSERT_EQ(again.bodies.size(), world.bodies.size());
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
    {
        EXPECT_EQ(again.bodies.position[b], world.bodies.position[b]);
        EXPECT_EQ(again.bodies.orientation[b].coeffs(), world.bodies.orientation[b].coeffs());
        EXPECT_EQ(again.bodies.scale[b], world.bodies.scale[b]);
        EXPECT_DOUBLE_EQ(again.bodies.mass[b], world.bodies.mass[b]);
    }
    ASSERT_EQ(again.contacts.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
    {
        EXPECT_EQ(again.contacts[i].key, contacts[i].key);
        EXPECT_EQ(again.contacts[i].patch.tangential, contacts[i].patch.tangential);
        EXPECT_EQ(again.contacts[i].patch.twist_stiffness, contacts[i].patch.twist_stiffness);
    }
}

/// With the tables in the other order the pair of a rock and a ball is reversed: forces on the one are then on the
/// other.
TEST_F(SavedBed, ContactsFollowTheOrderOfTheTables)
{
    const World again = build_world(test::load_text(text(from("ball", path) + from("clast", path))));
    const auto  count = static_cast<std::int64_t>(again.bodies.size());
    ASSERT_EQ(again.contacts.size(), 2u);
    EXPECT_EQ(again.contacts[0].key, dem::pair_key(1, 4));
    EXPECT_EQ(again.contacts[0].patch.tangential, Vec3<double>(-1, -2, -3));
    EXPECT_EQ(again.contacts[0].patch.normal, Vec3<double>(0, 0, -1));
    EXPECT_EQ(again.contacts[0].patch.torsion, 4);
    EXPECT_EQ(again.contacts[1].key, dem::pair_key(5, count + 4));
    // The position of a patch does not change in the world.
    const auto in_world = [](const World& of, std::size_t body, const Vec3<double>& place) -> Vec3<double>
    { return of.bodies.position[body] + of.bodies.orientation[body] * place; };
    EXPECT_LT((in_world(again, 1, again.contacts[0].place) - in_world(world, 1, contacts[0].place)).norm(), 1e-14);
    EXPECT_EQ(again.contacts[1].patch.tangential, Vec3<double>(7, 8, 9));
}

TEST_F(SavedBed, MismatchIsRefusedWithFileAndRange)
{
    const std::string both    = from("clast", path) + from("ball", path);
    const auto        mention = [&](const std::string& scene_text, const std::vector<std::string>& parts)
    {
        const std::string found = refusal(scene_text);
        SCOPED_TRACE(parts.back());
        EXPECT_NE(found.find(path), std::string::npos) << found;
        EXPECT_NE(found.find("accepted"), std::string::npos) << found;
        for (const std::string& part : parts) { EXPECT_NE(found.find(part), std::string::npos) << found; }
    };
    mention(text(both, 2800), {"density", "2700", "2800"});
    mention(text(both, 2700, "[0.2, 0.4, 0.4]"), {"outside the domain"});
    mention(text(from("clast", path)), {"no table takes", "ball"});
    mention(text(both + from("ball", path)), {"same rocks"});
    std::string renamed = text(both);
    for (auto at = renamed.find("\"ball\""); at != std::string::npos; at = renamed.find("\"ball\""))
    {
        renamed.replace(at, 6, "\"pebble\"");
    }
    mention(renamed, {"pebble", "shape = \"clast\"", "shape = \"ball\""});
    std::string fewer = text(both);
    fewer.replace(fewer.find("variants = 2"), 12, "variants = 1");
    mention(fewer, {"variants"});
    std::string other = text(both);
    other.replace(other.find("seed = 3"), 8, "seed = 4");
    mention(other, {"inertia"});
    EXPECT_NE(refusal(text(both + R"([[body]]
name     = "probe"
shape    = "ball"
material = "rock"
diameter = 0.1
mass     = 1.0
position = )" +
                           fmt::format("[{}, {}, {}]\n", world.bodies.position[0][0], world.bodies.position[0][1],
                                       world.bodies.position[0][2])))
                  .find("probe"),
              std::string::npos);
}

/// A ball hides a hemisphere and the cylinder below it: 4/3 over 2/3 + 1 radius; of two, one on the other, 4/3 twice
/// over 2/3 + 3. The columns are 1/32 of the diameter; tolerance 2 %: 812 of them are under a disc of 804.
TEST(Packing, FractionUnderTheVisibleSurface)
{
    const auto fraction = [](int count, const std::string& box)
    {
        const World world = build_world(test::load_text(text(drawn("ball", count, box))));
        return packing_fraction(world, fields_of(world));
    };
    // The smallest box that contains the ball's nodes.
    const double one = fraction(1, "[[0.0, 0.0, 0.0], [0.1001, 0.1001, 0.1001]]");
    const double two = fraction(2, "[[0.0, 0.0, 0.0], [0.1001, 0.1001, 0.202]]");
    EXPECT_NEAR(one, 0.8, 0.016);
    EXPECT_NEAR(two, 8.0 / 11.0, 0.016);
}

/// 1,600 balls beside each other have more columns of 1/32 than a million: fewer and wider ones find the same.
TEST(Packing, FractionOfABedWiderThanAMillionColumns)
{
    const World world = build_world(
        test::load_text(text(drawn("ball", 1600, "[[0.0, 0.0, 0.0], [8.0, 8.0, 0.1001]]"), 2700, "[8.0, 8.0, 0.4]")));
    EXPECT_NEAR(packing_fraction(world, fields_of(world)), 0.8, 0.016);
}

} // namespace
} // namespace tread::world
