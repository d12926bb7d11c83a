#include <gtest/gtest.h>

#include "scene/contacts.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

Scene load_text(const std::string& text)
{
    const Directory directory;
    return load_scene(directory.write("scene.toml", text), {});
}

TEST(Contact, a_given_pair_is_found_in_either_order)
{
    const auto scene = load_text(good_scene);
    EXPECT_EQ(contact_of(scene.contacts, "wheel", "sand").friction, 0.4);
    EXPECT_EQ(contact_of(scene.contacts, "sand", "wheel").friction, 0.4);
    EXPECT_EQ(contact_of(scene.contacts, "sand", "wheel").restitution, 0.5);
}

TEST(Contact, a_pair_left_out_has_the_documented_default)
{
    EXPECT_EQ(contact_of({}, "a", "b").friction, 0.3);
    EXPECT_EQ(contact_of({}, "a", "b").restitution, 0.5);
    EXPECT_EQ(contact_of({}, "a", "wall").friction, 0.5);
    EXPECT_EQ(contact_of({}, "wall", "a").friction, 0.5);
}

TEST(Contact, a_pair_with_the_wall_that_leaves_friction_out_has_the_walls_default)
{
    const auto pair  = "friction = 0.4\n[[contact]]\nbetween = [\"wheel\", \"wall\"]\nrestitution = 0.1";
    const auto scene = load_text(replaced(good_scene, "friction = 0.4", pair));
    EXPECT_EQ(contact_of(scene.contacts, "wheel", "wall").friction, 0.5);
    EXPECT_EQ(contact_of(scene.contacts, "wheel", "wall").restitution, 0.1);
}

TEST(Contact, loading_lists_each_pair_that_can_meet_once)
{
    // rock and wheel with each other and themselves (3), with sand (2), with the walls (2)
    EXPECT_EQ(load_text(good_scene).contacts.size(), 7u);
}

} // namespace
} // namespace tread::scene::test
