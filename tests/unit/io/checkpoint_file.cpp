#include "io/checkpoint_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "io/checkpoints.hpp"
#include "mpi_session.hpp"
#include "temporary_directory.hpp"

namespace tread::io
{
namespace
{

std::string write_some(const test::TemporaryDirectory& directory)
{
    const std::string path = directory.path("state.h5");
    CheckpointWriter  writer(test::world(), path);
    writer.write("points/mass", std::vector<float>{1, 2, 3}, 1);
    writer.write("bodies/position", std::vector<double>{1, 2, 3, -0.0, std::nan(""), 6}, 3);
    writer.write("contact/key", std::vector<std::uint64_t>{std::numeric_limits<std::uint64_t>::max()}, 1);
    writer.write("candidates/body", std::vector<std::int32_t>{}, 1);
    writer.text("scene", "title = \"\"\n");
    EXPECT_FALSE(std::filesystem::exists(path)) << "there before it is whole";
    const std::int64_t bytes = writer.finish();
    EXPECT_EQ(bytes, static_cast<std::int64_t>(std::filesystem::file_size(path)));
    return path;
}

TEST(CheckpointFile, GivesBackWhatItWasGiven)
{
    const test::TemporaryDirectory directory;
    const std::string              path = write_some(directory);
    EXPECT_FALSE(damage_of(test::world(), path));
    const CheckpointReader reader(path);
    EXPECT_EQ(reader.read<float>("points/mass", 1, 1, 2), (std::vector<float>{2, 3}));
    const auto row = reader.read<double>("bodies/position", 3, 1, 1);
    EXPECT_TRUE(std::signbit(row[0]) && std::isnan(row[1]));
    EXPECT_EQ(reader.read<std::uint64_t>("contact/key", 1, 0, 1)[0], std::numeric_limits<std::uint64_t>::max());
    EXPECT_TRUE(reader.read<std::int32_t>("candidates/body", 1, 0, 0).empty());
    EXPECT_EQ(reader.first_rows("points/mass"), (std::vector<std::int64_t>{0, 3}));
    EXPECT_EQ(reader.text("scene"), "title = \"\"\n");
    EXPECT_THROW(reader.read<float>("points/mass", 1, 2, 2), EnvironmentError);
    EXPECT_FALSE(reader.holds("points/volume"));
}

/// Every byte matters: of the head, of HDF5's own records, of the data.
TEST(CheckpointFile, AnyChangedByteIsFound)
{
    const test::TemporaryDirectory directory;
    const std::string              path  = write_some(directory);
    const std::string              whole = test::read_text(path);
    for (std::size_t at = 0; at < whole.size(); at += at < 640 ? 1 : 131)
    {
        std::string changed = whole;
        changed[at]         = static_cast<char>(changed[at] ^ 4);
        std::ofstream(path, std::ios::binary) << changed;
        EXPECT_TRUE(damage_of(test::world(), path)) << "byte " << at;
    }
    for (const std::size_t length : {std::size_t{0}, std::size_t{511}, std::size_t{512}, whole.size() - 1})
    {
        std::ofstream(path, std::ios::binary) << whole.substr(0, length);
        EXPECT_TRUE(damage_of(test::world(), path)) << "length " << length;
    }
    EXPECT_TRUE(damage_of(test::world(), directory.path("missing.h5")));
}

TEST(CheckpointFile, OneThatIsNotFinishedLeavesNothing)
{
    const test::TemporaryDirectory directory;
    {
        CheckpointWriter writer(test::world(), directory.path("state.h5"));
        writer.write("points/mass", std::vector<float>{1}, 1);
    }
    EXPECT_TRUE(std::filesystem::is_empty(directory.path("")));
}

TEST(Checkpoints, KeepsTheNewestAndNamesTheLast)
{
    const test::TemporaryDirectory directory;
    const Checkpoints              there(directory.path("checkpoints"));
    there.prepare();
    for (const std::int64_t step : {std::int64_t{9}, std::int64_t{100}, std::int64_t{12345678901}})
    {
        std::ofstream(there.path(step)) << step;
    }
    std::ofstream(directory.path("checkpoints/checkpoint_0000000200.h5.tmp")) << "half";
    EXPECT_EQ(there.newest_first(),
              (std::vector<std::string>{there.path(12345678901), there.path(100), there.path(9)}));
    there.settle(there.path(12345678901), 2);
    EXPECT_EQ(test::read_text(directory.path("checkpoints/latest")), "checkpoint_12345678901.h5\n");
    EXPECT_EQ(there.newest_first().size(), 2u);
    there.prepare();
    EXPECT_FALSE(std::filesystem::exists(directory.path("checkpoints/checkpoint_0000000200.h5.tmp")));
    there.remove_after(100);
    EXPECT_EQ(there.newest_first(), std::vector<std::string>{there.path(100)});
}

} // namespace
} // namespace tread::io
