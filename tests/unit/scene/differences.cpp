#include "scene/differences.hpp"

#include <gtest/gtest.h>

namespace tread::scene
{
namespace
{

constexpr const char* before =
    "title = \"a\"\n\n[domain]\nsize = [1, 1, 1]\n\n[[phase]]\nname = \"settle\"\nduration = "
    "0.1\n\n[[phase]]\nname = \"drive\"\nduration = 0.2\n\n[output]\nevery = 0.02\n";
constexpr const char* after = "title = \"b\"\n\n[domain]\nsize = [1, 1, 2]\n\n[[phase]]\nname = \"settle\"\nduration = "
                              "0.3\n\n[[phase]]\nname = \"drive\"\nmax_duration = 0.2\n\n[output]\nevery = 0.02\n";

std::vector<std::string> lines(std::size_t phase, bool refused)
{
    std::vector<std::string> found;
    for (const Difference& difference : differences(before, after))
    {
        if (may_change(difference, phase) != refused) { found.push_back(describe(difference)); }
    }
    return found;
}

TEST(Differences, AreNamedByTableIndexAndKey)
{
    EXPECT_EQ(lines(0, true), (std::vector<std::string>{"[domain] size: [1, 1, 2], was [1, 1, 1]",
                                                        "[[phase]] 1 duration: not given, was 0.2",
                                                        "[[phase]] 1 max_duration: 0.2, was not given"}));
    EXPECT_EQ(lines(0, false),
              (std::vector<std::string>{"title: \"b\", was \"a\"", "[[phase]] 0 duration: 0.3, was 0.1"}));
    EXPECT_TRUE(differences(before, before).empty());
}

/// A resolved scene has one motion a line.
TEST(Differences, OfEachMotionOfAPhaseCount)
{
    const auto text = [](double first, double second)
    {
        return "[[phase]]\nmotion = [\n  { body = \"a\", load = " + std::to_string(first) +
               " },\n  { body = \"b\", load = " + std::to_string(second) + " },\n]\nname = \"tow\"\n";
    };
    EXPECT_TRUE(differences(text(1, 2), text(1, 2)).empty());
    for (const auto& changed : {text(3, 2), text(1, 3)})
    {
        const auto found = differences(text(1, 2), changed);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].key, "motion");
        EXPECT_FALSE(may_change(found[0], 0));
    }
}

TEST(Differences, TheRightAnswerMay) { EXPECT_TRUE(may_change({"reference", 0, "form", "\"none\"", "\"weight\""}, 0)); }

/// Whether sand may sleep at all cannot change, because that is another state; and nothing changes in a run that has
/// ended.
TEST(Differences, WhenSandSleepsMay)
{
    const Difference sooner{"sleep", 0, "distance", "20.0", "0.35"};
    EXPECT_TRUE(may_change(sooner, 0));
    EXPECT_FALSE(may_change(sooner, no_phase_to_come));
    EXPECT_FALSE(may_change({"sleep", 0, "distance", "", "0.35"}, 0));
}

TEST(Differences, ThePastMayNotChange)
{
    EXPECT_EQ(lines(1, false), std::vector<std::string>{"title: \"b\", was \"a\""});
}

} // namespace
} // namespace tread::scene
