#include <gtest/gtest.h>

#include "io/checkpoint_file.hpp"
#include "mpi_session.hpp"
#include "solver/stage_clock.hpp"
#include "solver/state_file.hpp"
#include "temporary_directory.hpp"

// Report of stages for a run resumed from a checkpoint.
namespace
{

using namespace tread;
using namespace tread::solver;

/// The parts of a run may have run on different machines: durations of calls in one part do not predict those in
/// another.
TEST(StageClock, KeepsCallsAndSecondsOfThePartBefore)
{
    const test::TemporaryDirectory folder;
    const std::string              path = folder.path("checkpoint.h5");
    StageClock                     first;
    for (int call = 0; call < 3; ++call)
    {
        first.run_timed("move", [] {});
    }
    const std::vector<Stage> stages = {{"move", true, ""}, {"output", true, ""}};
    {
        io::CheckpointWriter writer(test::world(), path);
        StateFile            file(test::world(), writer, Fidelity::exact);
        first.transfer(file);
        writer.finish();
    }
    const io::CheckpointReader reader(path);
    StateFile                  file(test::world(), reader, Fidelity::exact);
    StageClock                 second;
    second.transfer(file);
    const auto there = first.reports(stages), loaded = second.reports(stages);
    ASSERT_EQ(loaded.size(), 1U);
    EXPECT_EQ(loaded[0].calls, 3);
    EXPECT_EQ(loaded[0].seconds, there[0].seconds);

    second.run_timed("move", [] {});
    second.run_timed("output", [] {});
    const auto after = second.reports(stages);
    ASSERT_EQ(after.size(), 2U);
    EXPECT_EQ(after[0].calls, 4);
    EXPECT_GE(after[0].seconds, loaded[0].seconds);
    EXPECT_EQ(after[1].calls, 1);
}

} // namespace
