#include <algorithm>
#include <cmath>
#include <vector>

#include "rock_rest.hpp"

// Rocks at rest on a plane, on a slope and on each other, damped and then left alone
// (docs/verification.md#rocks-at-rest).
namespace
{

using namespace tread;

template<class Exec>
class RocksAtRest : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(RocksAtRest, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeRocksAtRest : public RocksAtRest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeRocksAtRest, test::Backends, test::BackendNames);

// A rock rocks about its edge some five times a second, and local damping of 0.3 leaves (1 - 0.3)/(1 + 0.3) of its
// energy per cycle: 1e-7 after 13 cycles.
constexpr double damped_time = 2.6, free_time = 0.5;

/// Four of each kind, apart from each other, a millimetre above a floor tilted by `degrees`.
template<class Exec>
void rest_apart(const Exec& exec, double degrees)
{
    const test::RockForms forms;
    std::string           text =
        test::rock_domain({0.12, 0.08, 0.05}, degrees, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"",
                          "linear_overlap = 1e-2") +
        test::stone(1e7, 0.5, 0.5) + forms.text();
    int row = 0;
    for (const std::string kind : {"bumpy", "rounded", "cube"})
    {
        text += test::rocks_of(kind, 4, "grid", {0.01, 0.01 + 0.02 * row, 0}, {0.09, 0.027 + 0.02 * row, 0.017});
        ++row;
    }
    test::expect_rest(exec, text + test::phase("settle", 0.3, damped_time) + test::phase("rest", 0, free_time),
                      damped_time, free_time);
}

TYPED_TEST(FullSizeRocksAtRest, OnAPlane) { rest_apart(this->exec(), 0); }
TYPED_TEST(FullSizeRocksAtRest, OnASlopeOfTenDegrees) { rest_apart(this->exec(), 10); }

/// Two of each in a bin one and a half rocks wide: they lie on each other.
TYPED_TEST(RocksAtRest, OnEachOther)
{
    const test::RockForms forms;
    std::string           text =
        test::rock_domain({0.018, 0.018, 0.12}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"",
                          "linear_overlap = 1e-2") +
        test::stone(1e7, 0.5, 0.5) + forms.text();
    int layer = 0;
    for (const std::string kind : {"bumpy", "rounded", "cube"})
    {
        text += test::rocks_of(kind, 2, "rain", {0, 0, 0.036 * layer}, {0.018, 0.018, 0.036 * (layer + 1)});
        ++layer;
    }
    test::expect_rest(this->exec(), text + test::phase("settle", 0.3, damped_time) + test::phase("rest", 0, free_time),
                      damped_time, free_time);
}

} // namespace
