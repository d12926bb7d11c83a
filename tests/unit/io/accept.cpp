#include "io/accept.hpp"

#include <gtest/gtest.h>

#include "backend/vector.hpp"

namespace tread::io::accept
{
namespace
{

using Integers = std::vector<std::int32_t>;
using Numbers  = std::vector<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

struct Row
{
    double first, second;
};

/// Row at which a bound refuses values; -2: it accepts them.
template<class Bound, class T>
std::int64_t refused_at(const Bound& bound, const std::vector<T>& values)
{
    const Verdict verdict = bound(values);
    return verdict ? verdict->row : -2;
}

TEST(Accept, NumbersInTheirRange)
{
    EXPECT_EQ(refused_at(finite(), Numbers{1, -1e300}), -2);
    EXPECT_EQ(refused_at(finite(), Numbers{1, nan}), 1);
    EXPECT_EQ(refused_at(finite(), std::vector<float>{std::numeric_limits<float>::infinity()}), 0);
    EXPECT_EQ(refused_at(finite(), std::vector<Row>{{1, 2}, {3, 4}, {5, infinity}}), 2);
    EXPECT_EQ(refused_at(finite_or_none(), Numbers{nan, infinity}), 1);
    EXPECT_EQ(refused_at(positive(), Numbers{1, 0}), 1);
    EXPECT_EQ(refused_at(not_negative(), Numbers{0, -1e-300}), 1);
    EXPECT_EQ(refused_at(within(-1, 2), Integers{-1, 2, 3}), 2);
    EXPECT_EQ(refused_at(within(-1, 2), Numbers{nan}), 0);
    EXPECT_EQ(refused_at(index(2), Integers{0, 1}), -2);
    EXPECT_EQ(refused_at(index(2), Integers{0, 2}), 1);
    EXPECT_EQ(refused_at(index(2), Integers{-1}), 0);
    EXPECT_EQ(refused_at(index(0), Integers{}), -2);
}

TEST(Accept, SaysWhatItWouldAccept)
{
    const Verdict verdict = index(3)(Integers{0, 7});
    ASSERT_TRUE(verdict);
    EXPECT_EQ(verdict->value, "7");
    EXPECT_EQ(verdict->accepted, "0 to 2");
}

TEST(Accept, ListsThatCutAndNameOthers)
{
    EXPECT_EQ(refused_at(offsets(2, 5), Integers{0, 3, 5}), -2);
    EXPECT_EQ(refused_at(offsets(2, 5), Integers{0, 6, 5}), 2);
    EXPECT_EQ(refused_at(offsets(2, 5), Integers{1, 3, 5}), 0);
    EXPECT_EQ(refused_at(offsets(2, 5), Integers{0, 3, 4}), 2);
    EXPECT_EQ(refused_at(offsets(2, 5), Integers{0, 5}), -1);
    EXPECT_EQ(refused_at(permutation(3), Integers{2, 0, 1}), -2);
    EXPECT_EQ(refused_at(permutation(3), Integers{2, 0, 2}), 2);
    EXPECT_EQ(refused_at(permutation(3), Integers{2, -1, 0}), 1);
    EXPECT_EQ(refused_at(permutation(3), Integers{2, 3, 0}), 1);
    EXPECT_EQ(refused_at(ascending(), Integers{1, 1, 0}), 2);
    EXPECT_EQ(refused_at(distinct(), std::vector<std::uint64_t>{3, 1, 3}), -1);
    EXPECT_EQ(refused_at(all(rows(1), index(1)), Integers{0, 9}), -1);
    EXPECT_EQ(refused_at(all(rows(1), index(1)), Integers{9}), 0);
}

TEST(Accept, WhatTheSceneGives)
{
    EXPECT_EQ(refused_at(same_as(Integers{1, 2}), Integers{1, 2}), -2);
    EXPECT_EQ(refused_at(same_as(Integers{1, 2}), Integers{1, 3}), 1);
    EXPECT_EQ(refused_at(same_as(Integers{1, 2}), Integers{1}), -1);
    EXPECT_EQ(refused_at(same_as(Numbers{1, 2}), Numbers{1, 2 + 1e-9}), -2);
    EXPECT_EQ(refused_at(same_as(Numbers{1, 2}), Numbers{1, 2.001}), 1);
    EXPECT_EQ(refused_at(same_as(Numbers{1}), Numbers{nan}), 0);
    EXPECT_EQ(refused_at(same_as(std::vector<Row>{{1, 0}}), std::vector<Row>{{1, 1e-9}}), -2);
}

TEST(Accept, QuaternionsOfLengthOne)
{
    const Quat one(1, 0, 0, 0), half(0.5, 0, 0, 0), none(nan, 0, 0, 0);
    EXPECT_EQ(refused_at(unit_quaternions(), std::vector<Quat>{one, one}), -2);
    EXPECT_EQ(refused_at(unit_quaternions(), std::vector<Quat>{one, half}), 1);
    EXPECT_EQ(refused_at(unit_quaternions(), std::vector<Quat>{none}), 0);
}

} // namespace
} // namespace tread::io::accept
