#include <algorithm>
#include <ostream>

#include <gmock/gmock.h>

#include "scene/phase_settings.hpp"
#include "scene/resolved.hpp"
#include "scene_file.hpp"

// [[phase]] gravity, contacts and mass_scaling: from which phase on they hold, and what is refused, and where.
namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;

std::string with_phase(const std::string& keys)
{
    return good_scene + "[[phase]]\nname = \"turned\"\nduration = 2.0\n" + keys + "\n";
}

Scene load(const std::string& text)
{
    const Directory directory;
    return load_scene(directory.write("good.toml", text), {});
}

const Contact& between(const std::vector<Contact>& contacts, const std::string& a, const std::string& b)
{
    return *std::find_if(contacts.begin(), contacts.end(),
                         [&](const Contact& contact) {
                             return contact.between == std::array{a, b} || contact.between == std::array{b, a};
                         });
}

TEST(PhaseSettings, hold_until_another_phase_sets_them)
{
    const Scene scene = load(with_phase("gravity = [1.0, 0.0, -3.0]\ncontacts = [ { between = [\"sand\", \"wheel\"], "
                                        "friction = 0.1 } ]\n[[phase]]\nname = \"after\"\nduration = 1.0"));
    const auto  last  = scene.phases.size() - 1;
    EXPECT_EQ(gravity_in(scene, last - 2), scene.domain.gravity);
    for (const std::size_t phase : {last - 1, last})
    {
        EXPECT_EQ(gravity_in(scene, phase), (Vector3{1, 0, -3}));
        EXPECT_EQ(between(contacts_in(scene, phase), "wheel", "sand").friction, 0.1);
    }
    EXPECT_EQ(between(contacts_in(scene, last), "wheel", "sand").restitution,
              between(scene.contacts, "wheel", "sand").restitution);
    EXPECT_EQ(between(contacts_in(scene, last - 2), "wheel", "sand").friction,
              between(scene.contacts, "wheel", "sand").friction);
}

TEST(PhaseSettings, pairs_touch_or_not_until_another_phase_sets_it)
{
    const std::string pair  = "contacts = [ { between = [\"rock\", \"wheel\"], touch = ";
    const Scene       scene = load(with_phase(pair + "true } ]\n[[phase]]\nname = \"after\"\nduration = 1.0\n" + pair +
                                              "false } ]\n[[contact]]\nbetween = [\"wheel\", \"rock\"]\ntouch = false"));
    const auto        last  = scene.phases.size() - 1;
    EXPECT_FALSE(between(contacts_in(scene, 0), "wheel", "rock").touch);
    EXPECT_TRUE(between(contacts_in(scene, last - 1), "wheel", "rock").touch);
    EXPECT_FALSE(between(contacts_in(scene, last), "wheel", "rock").touch);
    EXPECT_TRUE(between(contacts_in(scene, last), "wheel", "sand").touch) << "what is left out touches";
    EXPECT_TRUE(changes_touch(scene));
    EXPECT_FALSE(changes_touch(load(good_scene + "[[contact]]\nbetween = [\"wheel\", \"rock\"]\ntouch = false")));
}

TEST(PhaseSettings, inertia_is_scaled_as_in_time_until_a_phase_sets_it)
{
    const std::string twice = with_phase("mass_scaling = 9\n[[phase]]\nname = \"after\"\nduration = 1.0");
    const Scene set = load(twice), not_set = load(good_scene), time = load(with_phase("") + "[time]\nmass_scaling = 4");
    const auto  last = set.phases.size() - 1;
    EXPECT_EQ(mass_scaling_in(set, last - 2), 1);
    EXPECT_EQ(mass_scaling_in(set, last - 1), 9);
    EXPECT_EQ(mass_scaling_in(set, last), 9);
    EXPECT_EQ(mass_scaling_in(time, last - 1), 4);
    EXPECT_TRUE(scales_inertia(set));
    EXPECT_TRUE(scales_inertia(time));
    EXPECT_FALSE(scales_inertia(not_set));
}

TEST(PhaseSettings, inertia_scaled_in_no_phase_leaves_nothing_of_it)
{
    std::string       none = with_phase("") + "[time]\nmass_scaling = 4\n";
    const std::string head = "[[phase]]\n";
    none.insert(none.find(head) + head.size(), "mass_scaling = 1\n");
    EXPECT_FALSE(scales_inertia(load(none)));
}

TEST(PhaseSettings, are_written_into_the_resolved_scene)
{
    const Scene scene = load(with_phase(
        "gravity = [1.0, 0.0, -3.0]\nmass_scaling = 9\ncontacts = [ { between = [\"sand\", \"wheel\"], "
        "restitution = 0.1, touch = false } ]\n[[contact]]\nbetween = [\"rock\", \"wheel\"]\ntouch = false"));
    EXPECT_EQ(load(resolved_toml(scene)), scene);
}

struct BadSetting
{
    const char* name;
    std::string keys;
    std::string said;
};

std::ostream& operator<<(std::ostream& stream, const BadSetting& bad) { return stream << bad.name; }

class BadPhaseSettings : public ::testing::TestWithParam<BadSetting>
{
};

TEST_P(BadPhaseSettings, are_refused_with_file_line_and_key)
{
    const std::string text = with_phase(GetParam().keys);
    const auto        line = std::count(good_scene.begin(), good_scene.end(), '\n') + 4;
    const auto        said = refusal(text);
    EXPECT_THAT(said, HasSubstr("bad.toml:" + std::to_string(line) + ": "));
    EXPECT_THAT(said, HasSubstr(GetParam().said));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
}

const std::vector<BadSetting> bad_settings{
    {"gravity_too_large", "gravity = [0, 0, 1e9]", "[phase.turned] gravity: element 2: 1000000000 is out of range"},
    {"gravity_no_vector", "gravity = 9.81", "[phase.turned] gravity: wrong type"},
    {"unknown_family", "contacts = [ { between = [\"sand\", \"weel\"], friction = 0.1 } ]",
     "[phase.turned] contacts: there is no contact family called \"weel\"; did you mean \"wheel\"?"},
    {"sets_nothing", "contacts = [ { between = [\"sand\", \"wheel\"] } ]",
     "[phase.turned] contacts: [\"sand\", \"wheel\"] sets nothing; accepted: friction, restitution or touch"},
    {"touch_no_boolean", "contacts = [ { between = [\"sand\", \"wheel\"], touch = \"no\" } ]",
     "[phase.turned.contacts[0]] touch: wrong type: the string \"no\"; accepted: true | false"},
    {"sand_without_walls", "contacts = [ { between = [\"sand\", \"wall\"], touch = false } ]",
     "[phase.turned] contacts: touch = false of [\"sand\", \"wall\"]: no rock or body is of this family, and sand "
     "always meets the walls; accepted: a pair with a family of rocks or bodies"},
    {"sand_without_sand", "contacts = [ { between = [\"sand\", \"sand\"], touch = false } ]",
     "no rock or body is of these families, and points of sand always meet"},
    {"two_walls", "contacts = [ { between = [\"wall\", \"wall\"], friction = 0.1 } ]",
     "[phase.turned] contacts: walls do not meet each other"},
    {"twice",
     "contacts = [ { between = [\"sand\", \"wheel\"], friction = 0.1 }, { between = [\"wheel\", \"sand\"], friction = "
     "0.2 } ]",
     "[phase.turned] contacts: [\"wheel\", \"sand\"] twice; accepted: one setting each"},
    {"friction_range", "contacts = [ { between = [\"sand\", \"wheel\"], friction = -0.1 } ]",
     "[phase.turned.contacts[0]] friction: -0.1 is out of range"},
    {"inertia_less_than_its_own", "mass_scaling = 0.5",
     "[phase.turned] mass_scaling: 0.5 is out of range; accepted: number >= 1 and <= 100"},
    {"no_array", "contacts = { between = [\"sand\", \"wheel\"] }", "[phase.turned] contacts: wrong type"},
};
std::string setting_name(const ::testing::TestParamInfo<BadSetting>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scene, BadPhaseSettings, ::testing::ValuesIn(bad_settings), setting_name);

} // namespace
} // namespace tread::scene::test
