#include <gmock/gmock.h>

#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;
using ::testing::StartsWith;

Scene load_with(const std::vector<std::string>& overrides)
{
    const Directory directory;
    return load_scene(directory.write("scene.toml", good_scene), overrides);
}

TEST(Override, sets_vectors_numbers_and_bare_words)
{
    const auto scene = load_with({"domain.gravity=[0, 0, -3.72]", "grid.spacing = 0.025", "numerics.precision=double",
                                  "title=two words", "time.dt=auto", "output.every=1"});
    EXPECT_EQ(scene.domain.gravity, (Vector3{0, 0, -3.72}));
    EXPECT_EQ(scene.grid.spacing, 0.025);
    EXPECT_EQ(scene.numerics.precision, Precision::double_);
    EXPECT_EQ(scene.title, "two words");
    EXPECT_FALSE(scene.time.dt.has_value());
    EXPECT_EQ(scene.output.every, 1.0);
}

TEST(Override, reaches_arrays_of_tables_by_name_and_by_index)
{
    const auto scene = load_with({"material.sand.young=2e6", "material[1].young=3e6", "terrain.0.points_per_cell=27",
                                  "phase.drive.drive.slip=0.7", "shape.clast.generate.seed=11"});
    EXPECT_EQ(scene.materials[0].young, 2e6);
    EXPECT_EQ(scene.materials[1].young, 3e6);
    EXPECT_EQ(scene.terrain[0].points_per_cell, 27);
    EXPECT_EQ(scene.phases[1].drive->slip, 0.7);
    EXPECT_EQ(std::get<RockGenerator>(scene.shapes[0].source).seed, 11u);
}

TEST(Override, the_last_one_wins)
{
    EXPECT_EQ(load_with({"grid.spacing=0.025", "grid.spacing=0.1"}).grid.spacing, 0.1);
}

TEST(Override, an_error_names_the_argument)
{
    EXPECT_THAT(
        refusal(good_scene, {"material.sand.yuong=1e6"}),
        StartsWith("--set material.sand.yuong=1e6: [material.sand] yuong: unknown key; did you mean \"young\"?"));
    EXPECT_THAT(refusal(good_scene, {"domian.size=[1,1,1]"}),
                StartsWith("--set domian.size=[1,1,1]: domian: unknown key"));
    EXPECT_THAT(refusal(good_scene, {"material.sand.density=-1"}),
                StartsWith("--set material.sand.density=-1: [material.sand] density: -1 is out of range"));
    EXPECT_THAT(refusal(good_scene, {"domain.gravity=[0,0"}), HasSubstr("wrong type: the string \"[0,0\""));
}

TEST(Override, a_place_that_is_not_there_is_an_error)
{
    EXPECT_THAT(refusal(good_scene, {"material.snad.young=1"}),
                AllOf(StartsWith("--set material.snad.young=1: "), HasSubstr("did you mean \"sand\"?")));
    EXPECT_THAT(refusal(good_scene, {"material[3].young=1"}), HasSubstr("nothing is called \"3\""));
    EXPECT_THAT(refusal(good_scene, {"grid.spacing.x=1"}), HasSubstr("\"x\" stands below a floating-point number"));
    EXPECT_THAT(
        refusal(good_scene, {"domain.gravity.z=-9.8"}),
        StartsWith("--set domain.gravity.z=-9.8: \"z\" stands below domain.gravity, which is an array of 3 values; "
                   "accepted: domain.gravity=[0, 0, -9.81], or domain.gravity[0] to domain.gravity[2]"));
    EXPECT_THAT(refusal(good_scene, {"domain.gravity[3]=1"}), HasSubstr("\"3\" stands below domain.gravity"));
    EXPECT_THAT(refusal(good_scene, {"grid.spacing"}), HasSubstr("is not of the form key=value"));
    for (const std::string wrong :
         {"grid.spacing=", "=1", "a..b=1", ".a=1", "a.=1", "a[0=1", "a[x]=1", "a[]=1", "a b=1"})
    {
        EXPECT_THAT(refusal(good_scene, {wrong}), HasSubstr("is not of the form key=value")) << wrong;
    }
}

TEST(Override, a_value_cannot_bring_a_second_key)
{
    EXPECT_THAT(refusal(good_scene, {"grid.spacing=1\nother=2"}), HasSubstr("wrong type: the string"));
}

} // namespace
} // namespace tread::scene::test
