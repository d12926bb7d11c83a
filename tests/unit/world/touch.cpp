#include <gmock/gmock.h>

#include "base/errors.hpp"
#include "scene_text.hpp"
#include "world/cover.hpp"
#include "world/world.hpp"

// Bodies and rocks that pass through others in the first phase may be placed inside them.
namespace tread::world
{
namespace
{

using ::testing::HasSubstr;

std::string refusal(const std::string& text)
{
    try
    {
        build_world(test::load_text(text));
    }
    catch (const InputError& error)
    {
        return error.what();
    }
    return "";
}

std::string contact(const std::string& a, const std::string& b)
{
    return "[[contact]]\nbetween = [\"" + a + "\", \"" + b + "\"]\ntouch = false\n";
}

/// The roller at another height, m.
std::string roller_at(const std::string& height, const std::string& more = "")
{
    std::string text = test::roller_text;
    return text.replace(text.find("position = [0.2, 0.2, 0.33]"), 27, "position = [0.2, 0.2, " + height + "]") + more;
}

/// The same scene, in which the roller's pair with `other` touches in the first phase and not in the next.
std::string later(std::string text, const std::string& other)
{
    return text + "[[phase]]\nname = \"later\"\nduration = 1.0\ncontacts = [ { between = [\"steel\", \"" + other +
           "\"], touch = false } ]\n";
}

TEST(Touch, ABodyMayStandInSandThatItDoesNotTouch)
{
    EXPECT_EQ(refusal(roller_at("0.15", contact("steel", "sand"))), "");
    EXPECT_THAT(refusal(later(roller_at("0.15"), "sand")), HasSubstr("points of sand stand inside it"));
}

TEST(Touch, ABodyMayStandInWallsThatItDoesNotTouch)
{
    EXPECT_EQ(refusal(roller_at("0.05", contact("steel", "sand") + contact("wall", "steel"))), "");
    EXPECT_THAT(refusal(later(roller_at("0.05", contact("steel", "sand")), "wall")), HasSubstr("m into a wall"));
}

TEST(Touch, ABodyMayStandInOneThatItDoesNotTouch)
{
    const std::string second = "[[body]]\nname = \"other\"\nshape = \"roller\"\nmaterial = \"steel\"\nmass = 6.0\n"
                               "position = [0.2, 0.2, 0.35]\n";
    EXPECT_EQ(refusal(roller_at("0.33", second + contact("steel", "steel"))), "");
    EXPECT_THAT(refusal(later(roller_at("0.33", second), "steel")), HasSubstr("its position puts it into 'roller'"));
}

TEST(Touch, OnSurfaceIsOnWhatABodyTouchesInTheFirstPhase)
{
    EXPECT_THAT(refusal(roller_at("\"on surface\"", contact("steel", "sand"))),
                HasSubstr("neither sand nor a rock that it touches in the first phase lies under it"));
}

TEST(Touch, RocksMayStandInSandThatTheyDoNotTouch)
{
    const std::string  text   = test::sand_text + test::rocks_text + "placement = \"grid\"\n";
    const scene::Scene scene  = test::load_text(text + contact("rock", "sand"));
    const std::size_t  points = build_world(scene).sand.size();
    EXPECT_EQ(points, build_world(test::load_text(test::sand_text)).sand.size()) << "no sand makes room";
    EXPECT_THAT(refusal(text), HasSubstr("points of sand stand where rocks are placed"));
}

} // namespace
} // namespace tread::world
