#include "io/run_directory.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "io/files.hpp"
#include "io/h5.hpp"
#include "mpi_session.hpp"
#include "temporary_directory.hpp"

namespace tread::io
{
namespace
{

using test::world;
namespace fs = std::filesystem;

ExitCode code_of_create(const std::string& path, Existing existing, std::string& message,
                        const std::vector<NeededFile>& needed = {})
{
    try
    {
        RunDirectory::create(world(), {path, existing, "scene", needed});
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
    const RunDirectory             run =
        RunDirectory::create(world(), {directory.path("a/b/"), Existing::refuse, "title = 1\n", {}});
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

    // scene.toml cannot be written if its temporary name is taken by a directory
    fs::create_directories(directory.path("run/scene.toml.tmp"));
    std::ofstream(directory.path("run/log.txt")) << "old";
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::overwrite, message), ExitCode::environment);
    EXPECT_FALSE(fs::exists(directory.path("run/scene.toml")));
    EXPECT_EQ(test::read_text(directory.path("run/log.txt")), "old");
}

TEST(RunDirectory, a_lock_of_others_is_no_mark_of_a_run_and_stays)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    fs::create_directories(directory.path("run/checkpoints"));
    std::ofstream(directory.path("run/.lock")) << "of a package manager";
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::bad_input);
    EXPECT_NE(message.find("'checkpoints'"), std::string::npos) << message;
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::overwrite, message), ExitCode::bad_input);
    EXPECT_NE(message.find("run/.lock"), std::string::npos) << message;
    EXPECT_EQ(test::read_text(directory.path("run/.lock")), "of a package manager");
    EXPECT_TRUE(fs::exists(directory.path("run/checkpoints")));

    fs::resize_file(directory.path("run/.lock"), 0); // an empty lock file names no holder, and may be overwritten
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::bad_input);
    EXPECT_EQ(code_of_create(directory.path("run"), Existing::overwrite, message), ExitCode::finished);
}

TEST(RunDirectory, what_the_run_needs_is_never_replaced)
{
    const test::TemporaryDirectory directory;
    std::string                    message;
    ASSERT_EQ(code_of_create(directory.path("run"), Existing::refuse, message), ExitCode::finished);
    fs::create_directories(directory.path("run/snapshots"));
    fs::create_directory_symlink(directory.path("run"), directory.path("other"));
    for (const char* name : {"bed.h5", "snapshots/rock.stl", "notes.csv", "scene.toml.tmp"})
    {
        std::ofstream(directory.path(std::string("run/") + name)) << name;
    }
    const auto code = [&](const std::string& run, const std::string& file)
    {
        return code_of_create(directory.path(run), Existing::overwrite, message,
                              {{directory.path(file), "[[rocks]] 0 from"}});
    };
    for (const char* file : {"run/bed.h5", "other/bed.h5", "run/./bed.h5", "run/snapshots/rock.stl", "run/scene.toml",
                             "run/scene.toml.tmp"})
    {
        for (const char* run : {"run", "other", "other/"})
        {
            EXPECT_EQ(code(run, file), ExitCode::bad_input) << run << ' ' << file;
            EXPECT_NE(message.find("[[rocks]] 0 from"), std::string::npos) << message;
            EXPECT_NE(message.find(directory.path(file)), std::string::npos) << message;
        }
    }
    EXPECT_EQ(test::read_text(directory.path("run/bed.h5")), "bed.h5");
    EXPECT_EQ(code("run", "run/notes.csv"), ExitCode::finished);
    EXPECT_EQ(test::read_text(directory.path("run/notes.csv")), "notes.csv");
    EXPECT_FALSE(fs::exists(directory.path("run/bed.h5")));
}

class Links : public ::testing::Test
{
protected:
    /// Creates a link in the run directory to a file outside, which contains "mine".
    void link(const std::string& name)
    {
        fs::create_directories(directory_.path("run"));
        std::ofstream(directory_.path("outside")) << "mine";
        fs::create_symlink(directory_.path("outside"), directory_.path("run/" + name));
    }
    std::string outside() const { return test::read_text(directory_.path("outside")); }

    test::TemporaryDirectory directory_;
    std::string              message_;
};

TEST_F(Links, lead_no_writing_out_of_the_directory)
{
    for (const char* name : {"scene.toml.tmp", "log.txt", "timeseries.h5"}) { link(name); }
    EXPECT_EQ(code_of_create(directory_.path("run"), Existing::refuse, message_), ExitCode::bad_input);
    EXPECT_EQ(code_of_create(directory_.path("run"), Existing::overwrite, message_), ExitCode::finished);
    EXPECT_EQ(outside(), "mine");
    EXPECT_EQ(test::read_text(directory_.path("run/scene.toml")), "scene");
}

TEST_F(Links, as_a_lock_are_refused)
{
    link(".lock");
    EXPECT_EQ(code_of_create(directory_.path("run"), Existing::overwrite, message_), ExitCode::bad_input);
    EXPECT_NE(message_.find("run/.lock"), std::string::npos) << message_;
    EXPECT_EQ(outside(), "mine");
}

TEST_F(Links, that_lead_nowhere_are_in_the_way)
{
    fs::create_directories(directory_.path("run"));
    fs::create_symlink(directory_.path("nowhere"), directory_.path("run/timeseries.h5"));
    EXPECT_EQ(code_of_create(directory_.path("run"), Existing::refuse, message_), ExitCode::bad_input);
    EXPECT_NE(message_.find("'timeseries.h5'"), std::string::npos) << message_;
}

TEST_F(Links, are_replaced_by_what_is_written_under_their_names)
{
    for (const char* name : {"summary.json", "summary.json.tmp", "bed.h5"}) { link(name); }
    write_atomically(directory_.path("run/summary.json"), "new");
    EXPECT_EQ(test::read_text(directory_.path("run/summary.json")), "new");
    require_space(directory_.path("run/summary.json"), 1);
    h5::File::create(directory_.path("run/bed.h5")).close();
    EXPECT_FALSE(fs::is_symlink(directory_.path("run/bed.h5")));
    EXPECT_EQ(outside(), "mine");
}

} // namespace
} // namespace tread::io
