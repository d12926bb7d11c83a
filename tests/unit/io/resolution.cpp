#include "io/resolution.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace tread::io
{
namespace
{

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

TEST(Figure, IsAsGoodAsItsBounds)
{
    const auto less = [](double value) { return Figure{"overlap", value, 0.1, 0.3}.verdict(); };
    const auto more = [](double value) { return Figure{"cells", value, 20, 6}.verdict(); };
    EXPECT_EQ(less(0.1), Verdict::resolved);
    EXPECT_EQ(less(0.11), Verdict::marginal);
    EXPECT_EQ(less(0.31), Verdict::under_resolved);
    EXPECT_EQ(more(20), Verdict::resolved);
    EXPECT_EQ(more(19), Verdict::marginal);
    EXPECT_EQ(more(5), Verdict::under_resolved);
    EXPECT_EQ(less(no_number), Verdict::under_resolved);
    EXPECT_EQ(more(no_number), Verdict::under_resolved);
}

TEST(Verdict, IsTheWorstFiguresAndTheLogSaysWhy)
{
    const std::vector<Figure> figures = {{"overlap", 0.05, 0.1, 0.3}, {"cells", 7, 20, 6}, {"error", 0.2, 0.01, 0.05}};
    EXPECT_EQ(verdict_of({figures[0]}), Verdict::resolved);
    EXPECT_EQ(verdict_of({figures[0], figures[1]}), Verdict::marginal);
    EXPECT_EQ(verdict_line({figures[0]}), "resolved");
    EXPECT_EQ(verdict_line(figures),
              "under-resolved: cells 7 (resolved from 20, marginal from 6); error 0.2 (resolved to "
              "0.01, marginal to 0.05)");
}

} // namespace
} // namespace tread::io
