#include "io/time_series.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "h5_read.hpp"
#include "temporary_directory.hpp"

namespace tread::io
{
namespace
{

const std::vector<Column> columns = {{"time", 1, "s"}, {"force", 3, "N"}};

TEST(TimeSeries, rows_of_every_flush_follow_each_other)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("timeseries.h5");

    TimeSeries series(path);
    series.add_table({"/wheel/front", columns});
    series.add_table({"/energy", {{"total", 1, "J"}}});
    series.append("/wheel/front", {0.0, 1, 2, 3});
    series.append("/wheel/front", {0.1, 4, 5, 6});
    series.flush();
    EXPECT_EQ(test::read_dataset(path, "/wheel/front/time").values, (std::vector<double>{0.0, 0.1}));

    series.append("/wheel/front", {0.2, 7, 8, 9});
    series.append("/energy", {12});
    series.flush();
    const test::Dataset force = test::read_dataset(path, "/wheel/front/force");
    EXPECT_EQ(force.shape, (std::vector<hsize_t>{3, 3}));
    EXPECT_EQ(force.values, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(force.units, "N");
    EXPECT_EQ(test::read_dataset(path, "/energy/total").values, (std::vector<double>{12}));
}

TEST(TimeSeries, many_rows_cross_chunks)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("timeseries.h5");

    TimeSeries series(path);
    series.add_table({"/t", columns});
    for (int i = 0; i < 3000; ++i)
    {
        series.append("/t", {double(i), 1.0 * i, 2.0 * i, 3.0 * i});
        if (i % 700 == 0) { series.flush(); }
    }
    series.flush();
    const test::Dataset force = test::read_dataset(path, "/t/force");
    ASSERT_EQ(force.values.size(), 9000u);
    for (std::size_t i = 0; i < 3000; ++i) { ASSERT_EQ(force.values[3 * i + 2], 3.0 * double(i)); }
}

// h5py and other readers lock the file that they read; a run must not be stopped by that.
TEST(TimeSeries, reader_with_a_lock_does_not_stop_the_run)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("timeseries.h5");

    TimeSeries series(path);
    series.add_table({"/t", columns});
    const int reader = open(path.c_str(), O_RDONLY);
    ASSERT_EQ(flock(reader, LOCK_SH | LOCK_NB), 0);
    series.append("/t", {0, 1, 2, 3});
    EXPECT_NO_THROW(series.flush());
    close(reader);
    EXPECT_EQ(test::read_dataset(path, "/t/time").values.size(), 1u);
}

TEST(TimeSeries, unwritable_place_names_path_and_reason)
{
    try
    {
        TimeSeries series("/proc/nowhere/timeseries.h5");
        FAIL() << "no error";
    }
    catch (const EnvironmentError& error)
    {
        EXPECT_NE(std::string(error.what()).find("/proc/nowhere/timeseries.h5"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
    }
}

TEST(TimeSeries, row_of_another_width_is_refused)
{
    const test::TemporaryDirectory directory;
    TimeSeries                     series(directory.path("timeseries.h5"));
    series.add_table({"/t", columns});
    EXPECT_THROW(series.append("/t", {0, 1}), std::logic_error);
}

} // namespace
} // namespace tread::io
