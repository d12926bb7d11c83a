#include <gtest/gtest.h>

#include "kernels/dem/bodies.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

// Checkpoints and migration use for_each_field: an array missing from it would be lost.
namespace tread
{
namespace
{

/// Number of arrays in a struct of arrays, from its size; `others`: bytes of all other members.
template<class Struct>
std::size_t arrays_in(std::size_t others)
{
    static_assert(sizeof(Array<Cpu, double>) == sizeof(Array<Cpu, std::uint8_t>));
    return (sizeof(Struct) - others) / sizeof(Array<Cpu, double>);
}

TEST(ForEachField, VisitsEveryArrayOfThePoints)
{
    Counters                 counters;
    mpm::Points<Cpu, double> points(Cpu{&counters});
    points.allocate(1, {true, true, true, true, true});
    std::size_t fields = 0, components = 0;
    points.for_each_named_field(
        [&](const char*, auto& array, int width)
        {
            ++fields;
            components += static_cast<std::size_t>(array.size() == width);
        });
    const std::size_t counts = sizeof(points.count) + sizeof(points.stride);
    EXPECT_EQ(fields, arrays_in<decltype(points)>(counts));
    EXPECT_EQ(components, fields) << "a field has another width than it is visited with";
}

/// Far cells follow from keys and owners.
TEST(ForEachField, VisitsEveryArrayOfThePagesButTheFarCells)
{
    Counters        counters;
    mpm::Pages<Cpu> pages(Cpu{&counters});
    std::size_t     fields = 0;
    pages.for_each_field([&](const char*, auto&) { ++fields; });
    EXPECT_EQ(fields + 1, arrays_in<decltype(pages)>(0));
}

/// Roles and numbers differ between ranks, and who is asleep stands with the rest of the sleep
/// (solver/bodies/body_sleep.cpp).
TEST(ForEachField, VisitsEveryArrayOfTheBodiesButThoseOfRanksAndSleep)
{
    Counters         counters;
    dem::Bodies<Cpu> bodies(Cpu{&counters});
    std::size_t      fields = 0;
    bodies.for_each_field([&](const char*, auto&) { ++fields; });
    EXPECT_EQ(fields + 3, arrays_in<decltype(bodies)>(0));
}

} // namespace
} // namespace tread
