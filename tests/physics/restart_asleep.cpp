#include "restart.hpp"
#include "thrown_roller.hpp"

// Runs that are stopped while sand or rocks sleep.
namespace
{

using namespace tread;

template<class Exec>
class RestartAsleep : public test::RestartTest<Exec>
{
};
TYPED_TEST_SUITE(RestartAsleep, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeRestartAsleep : public RestartAsleep<Exec>
{
};
TYPED_TEST_SUITE(FullSizeRestartAsleep, test::Backends, test::BackendNames);

/// Far from the roller: sleeping sand is saved asleep, and other sand falls asleep or wakes afterwards.
TYPED_TEST(FullSizeRestartAsleep, OfSandGivesTheSameBits)
{
    std::string text = test::sand_text + test::thrown_roller_text +
                       "[sleep]\ndistance = 0.05\nspeed = 0.01\nrest = 2e-3\nload = 0.5\n";
    for (const std::string box : {"[0.4, 0.4, 0.6]", "[0.4, 0.4, 0.2]"}) { text.replace(text.find(box), 4, "[1.6"); }
    const test::Sleepers asleep = this->expect_same_bits(text);
    EXPECT_GT(asleep.saved, 0);
    EXPECT_NE(asleep.at_end, asleep.saved);
}

/// Sleeping rocks are saved asleep with their contacts; others fall asleep or wake afterwards.
TYPED_TEST(FullSizeRestartAsleep, OfRocksGivesTheSameBits)
{
    this->expect_same_bits(test::rocks_alone + test::rocks_text + "placement = \"grid\"\n" + test::thrown_roller_text +
                           "[time]\ndt = 3e-3\n[sleep]\nrock_speed = 0.15\nrock_rest = 0.02\n");
    std::cout << this->rocks_saved_ << " rocks asleep when saved, " << this->rocks_at_end_ << " at the end\n";
    EXPECT_GT(this->rocks_saved_, 0);
    EXPECT_NE(this->rocks_at_end_, this->rocks_saved_);
}

/// Sand and rocks that sleep together are saved with what the sand presses the rocks with; the roller wakes both.
TYPED_TEST(RestartAsleep, OfSandAndRocksGivesTheSameBits)
{
    bool changes = false;
    for (const std::string diameter : {"0.06", "0.025"}) // smaller rocks take samples of points
    {
        std::string rocks = test::rocks_text + "placement = \"replace\"\n";
        rocks.replace(rocks.find("= 0.06"), 6, "= " + diameter);
        std::string text = test::sand_text + rocks + test::thrown_roller_text +
                           "[sleep]\ndistance = 0.05\nspeed = 0.05\nrest = 2e-3\nload = 0.5\nrock_speed = 0.05\n"
                           "rock_rest = 2e-3\nrock_load = 0.5\n";
        for (const std::string box : {"[0.4, 0.4, 0.6]", "[0.4, 0.4, 0.2]"})
        {
            for (auto at = text.find(box); at != std::string::npos; at = text.find(box))
            {
                text.replace(at, 4, "[1.6");
            }
        }
        const test::Sleepers asleep = this->expect_same_bits(text);
        std::cout << "rocks of " << diameter << " m: " << asleep.saved << " points and " << this->rocks_saved_
                  << " rocks asleep when saved, " << asleep.at_end << " and " << this->rocks_at_end_ << " at the end, "
                  << this->contacts_saved_ << " contacts of both saved\n";
        EXPECT_GT(asleep.saved, 0);
        EXPECT_GT(this->rocks_saved_, 0);
        EXPECT_GT(this->contacts_saved_, 0);
        changes = changes || asleep.at_end != asleep.saved || this->rocks_at_end_ != this->rocks_saved_;
    }
    EXPECT_TRUE(changes);
}

} // namespace
