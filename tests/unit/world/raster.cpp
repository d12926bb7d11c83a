#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "temporary_directory.hpp"
#include "world/raster.hpp"

namespace
{

using namespace tread;
using namespace tread::world;

const scene::PlanExtent unit_plan{{{0, 0}, {1, 1}}};

scene::RasterFile written(const test::TemporaryDirectory& folder, const std::string& name, const std::string& text)
{
    std::ofstream(folder.path(name), std::ios::binary) << text;
    return {folder.path(name), -1, 3, 0.001, unit_plan};
}

/// Interpolation reproduces functions that are linear in x and in y: exact except for rounding.
TEST(Raster, BilinearFunctionsAreExact)
{
    const auto f    = [](double x, double y) { return 2 * x - 3 * y + 0.5 * x * y + 1; };
    const auto plan = scene::PlanExtent{{{-1, 2}, {3, 5}}};
    Raster     field{5, 4, {}};
    for (std::size_t row = 0; row < field.rows; ++row)
    {
        for (std::size_t column = 0; column < field.columns; ++column)
        {
            field.heights.push_back(f(-1 + 4 * double(column) / 4, 5 - 3 * double(row) / 3));
        }
    }
    double worst = 0;
    for (double x = -1; x <= 3; x += 0.037)
    {
        for (double y = 2; y <= 5; y += 0.041)
        {
            worst = std::max(worst, std::abs(bilinear(field, plan, x, y) - f(x, y)));
        }
    }
    std::cout << "bilinear: worst error " << worst << ", tolerance 1e-13 (rounding of values near 20)\n";
    EXPECT_LT(worst, 1e-13);
    EXPECT_EQ(bilinear(field, plan, 3, 5), f(3, 5));
    EXPECT_TRUE(std::isnan(bilinear(field, plan, 3.01, 4)));
}

TEST(Raster, TheFirstRowIsAtHighY)
{
    const test::TemporaryDirectory folder;
    const auto                     raster = read_raster(written(folder, "a.csv", "# heights\n1, 2\n\n 3 ,4e0\n"));
    EXPECT_EQ(raster.rows, 2u);
    EXPECT_DOUBLE_EQ(bilinear(raster, unit_plan, 0, 1), 0.001);
    EXPECT_DOUBLE_EQ(bilinear(raster, unit_plan, 1, 1), 0.002);
    EXPECT_DOUBLE_EQ(bilinear(raster, unit_plan, 0, 0), 0.003);
    EXPECT_DOUBLE_EQ(bilinear(raster, unit_plan, 0.5, 0.5), 0.0025);
}

/// low = -1 is black, high = 3 is white: three quarters give 2.
TEST(Raster, PicturesOfAllKindsSayTheSame)
{
    using namespace std::string_literals;
    const test::TemporaryDirectory folder;
    const std::vector<double>      expected{-1, 3, 2, -1};
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"plain.pgm", "P2 # a comment\n2 2\n4\n0 4\n3 0\n"},
             {"raw.pgm", "P5\n2 2\n4\n\x00\x04\x03\x00"s},
             {"wide.pgm", "P5\n2 2\n400\n\x00\x00\x01\x90\x01\x2c\x00\x00"s}})
    {
        EXPECT_EQ(read_raster(written(folder, name, text)).heights, expected) << name;
    }
}

struct BadRaster
{
    std::string name;
    std::string text;
    std::string message;
};

TEST(Raster, BadFilesAreRefusedWithTheirLine)
{
    using namespace std::string_literals;
    const test::TemporaryDirectory folder;
    for (const auto& bad : std::vector<BadRaster>{
             {"magic.pgm", "P6 2 2 255 ", "magic.pgm:1: no PGM; accepted: a file that begins with P2 or P5"},
             {"header.pgm", "P5\n2", "header.pgm:2: the file ends before the height"},
             {"huge.pgm", "P5\n99999999 99999999 255\n", "huge.pgm: 99999999 x 99999999 samples"},
             {"overflow.pgm", "P5\n99999999999999999999999 2 255\n", "overflow.pgm:2: no width here"},
             {"one.pgm", "P5\n1 2 255\n", "one.pgm:2: no width here; accepted: integer 2 to"},
             {"white.pgm", "P2\n2 2\n70000\n", "white.pgm:3: no largest grey value here; accepted: integer 1 to 65535"},
             {"short.pgm", "P5\n2 2\n255\nabc", "short.pgm:4: the file is cut short: 3 of 4 bytes"},
             {"plain.pgm", "P2\n2 2\n255\n1 2 3 x", "plain.pgm:4: no sample here; accepted: integer 0 to 255"},
             {"over.pgm", "P2\n2 2\n9\n1 2 3 10", "over.pgm:4: no sample here; accepted: integer 0 to 9"},
             {"raw.pgm", "P5\n2 2\n9\n\x01\x02\x03\x0a"s, "sample 3 is 10; accepted: 0 to 9"},
             {"nan.csv", "1,2\n3,nan\n", "nan.csv:2: \"nan\" in column 2; accepted: finite number"},
             {"word.csv", "1,2\n3,4x\n", "word.csv:2: \"4x\" in column 2"},
             {"hole.csv", "1,2\n3,\n", "hole.csv:2: \"\" in column 2"},
             {"ragged.csv", "1,2\n3,4\n5\n", "ragged.csv:3: 1 numbers; accepted: 2, as in the first row"},
             {"row.csv", "1,2\n", "row.csv: 2 x 1 samples; accepted: at least 2 x 2"},
             {"empty.csv", "", "empty.csv: 0 x 1 samples"}})
    {
        try
        {
            read_raster(written(folder, bad.name, bad.text));
            ADD_FAILURE() << bad.name << " was accepted";
        }
        catch (const InputError& error)
        {
            EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(read_raster({folder.path("none.csv"), 0, 1, 1, unit_plan}), InputError);
}

} // namespace
