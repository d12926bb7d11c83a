#include "io/run_directory.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "mpi_session.hpp"
#include "temporary_directory.hpp"

namespace tread::io
{
namespace
{

using test::world;
namespace fs = std::filesystem;

ExitCode code_of_create(const std::string& path, Existing existing, std::string& message)
{
    try
    {
        RunDirectory::create(world(), path, existing, "scene");
    }
    catch (const Error& error)
    {
        message = error.what();
        return error.code();
    }
    return ExitCode::finished;
}

TEST(RunDirectory, makes_the_directories_above_and_writes_the_scene)
{
    const test::TemporaryDirectory directory;
    const RunDirectory run = RunDirectory::create(world(), directory.path("a/b/"), Existing::refuse, "title = 1\n");
    EXPECT_EQ(run.path(), directory.path("a/b"));
    EXPECT_EQ(test::read_text(directory.path("a/b/scene.toml")), "title = 1\n");
}

TEST(RunDirectory, refuses_a_run_and_names_the_way_out)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    ASSERT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::finished);
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::bad_input);
    EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
    EXPECT_NE(message.find(directory.path("run")), std::string::npos) << message;
}

TEST(RunDirectory, overwrite_removes_the_old_run_and_nothing_else)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    ASSERT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::finished);
    fs::create_directories(directory.path("run/snapshots"));
    std::ofstream(directory.path("run/snapshots/points_0000.hdf")) << "old";
    std::ofstream(directory.path("run/summary.json")) << "old";
    std::ofstream(directory.path("run/notes.txt")) << "mine";

    EXPECT_EQ(code_of_create(directory.path("run"), Existing::overwrite, message), ExitCode::finished);
    EXPECT_FALSE(fs::exists(directory.path("run/snapshots")));
    EXPECT_FALSE(fs::exists(directory.path("run/summary.json")));
    EXPECT_EQ(test::read_text(directory.path("run/notes.txt")), "mine");
}

TEST(RunDirectory, directory_of_others_is_no_run)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    fs::create_directories(directory.path("run"));
    std::ofstream(directory.path("run/notes.txt")) << "mine";
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::finished);
}

TEST(RunDirectory, files_of_others_are_not_replaced)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    fs::create_directories(directory.path("run/snapshots"));
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::bad_input);
    EXPECT_NE(message.find("'snapshots'"), std::string::npos) << message;
    EXPECT_TRUE(fs::exists(directory.path("run/snapshots")));
}

TEST(RunDirectory, a_run_killed_while_it_was_prepared_is_no_ones)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    ASSERT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::finished);
    fs::remove(directory.path("run/scene.toml"));
    std::ofstream(directory.path("run/log.txt")) << "old";
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::finished);
    EXPECT_FALSE(fs::exists(directory.path("run/log.txt")));
}

TEST(RunDirectory, unusable_place_is_an_environment_error_and_leaves_nothing)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    std::ofstream(directory.path("file")) << "in the way";
    EXPECT_EQ(code_of_create(directory.path("file/run"), Existing::refuse, message), ExitCode::environment);
    EXPECT_NE(message.find("file/run"), std::string::npos) << message;
    EXPECT_EQ(code_of_create("/proc/nowhere/run", Existing::overwrite, message), ExitCode::environment);

    // scene.toml cannot be written where a directory has its temporary name
    fs::create_directories(directory.path("run/scene.toml.tmp"));
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::environment);
    EXPECT_FALSE(fs::exists(directory.path("run/scene.toml")));
}

} // namespace
} // namespace tread::io
