#include <algorithm>
#include <cmath>

#include "energy_balance.hpp"
#include "rock_rest.hpp"

// Rocks of two sizes, of which the small ones have contacts too stiff for the substeps of the large ones and move in
// parts of them (docs/theory.md#subcycles).
namespace
{

using namespace tread;

template<class Exec>
class Subcycling : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Subcycling, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeSubcycling : public Subcycling<Exec>
{
};
TYPED_TEST_SUITE(FullSizeSubcycling, test::Backends, test::BackendNames);

/// A bin three rocks of 10 mm wide, into which eighteen of them and three of 4 mm fall.
std::string two_sizes(double share, int subcycles)
{
    const auto rocks = [](int count, double diameter, double low, double high)
    {
        return fmt::format(R"(
[[rocks]]
shape = "bumpy"
material = "stone"
count = {}
diameter = {}
placement = "rain"
region = {{ box = [[0.0, 0.0, {}], [0.03, 0.03, {}]] }}
)",
                           count, diameter, low, high);
    };
    return test::rock_domain({0.03, 0.03, 0.12}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"",
                             "linear_overlap = 1e-2") +
           fmt::format("[time]\ncontact_share = {}\nsubcycles = {}\n", share, subcycles) + test::stone(1e7, 0.5, 0.5) +
           "[[shape]]\nname = \"bumpy\"\ngenerate = { kind = \"rock\", seed = 5, nodes = 162 }\nsdf_cells = 40\n" +
           rocks(9, 0.01, 0.0, 0.03) + rocks(3, 0.004, 0.03, 0.04) + rocks(9, 0.01, 0.045, 0.08);
}

/// What a run took, and how it kept its balance.
struct Fallen
{
    double       unaccounted = 0; ///< largest share of the largest energy
    std::int64_t substeps    = 0;
    double       parts       = 0; ///< sum over substeps
};

template<class Exec>
Fallen fall(const Exec& exec, double share, int subcycles, double duration)
{
    test::Experiment<Exec> run(exec, two_sizes(share, subcycles) + test::phase("fall", 0, duration));
    Fallen                 found;
    while (run.time() < duration)
    {
        const solver::TimeStep step = run.advance();
        found.substeps += step.substeps;
        found.parts += static_cast<double>(step.substeps * step.subcycles);
        solver::Ledger& ledger = run.simulation().ledger();
        ledger.energy(run.simulation().census());
        found.unaccounted = std::max(found.unaccounted, std::abs(ledger.errors().energy));
    }
    return found;
}

/// Takes as many substeps as four times the share does, and keeps the balance of the share; without damping.
TYPED_TEST(Subcycling, KeepTheBalanceOfRocksThatFall)
{
    constexpr double duration = 0.4, share = 0.2;
    constexpr int    parts = 4;
    const Fallen parted = fall(this->exec(), share, parts, duration), alike = fall(this->exec(), share, 1, duration),
                 longer = fall(this->exec(), parts * share, 1, duration);
    test::report("substeps over those of four times the share",
                 static_cast<double>(parted.substeps) / static_cast<double>(longer.substeps), 1, 0.2,
                 "the stiffest body decides both; rocks fall elsewhere");
    test::report("substeps in parts over all", parted.parts / static_cast<double>(parts * parted.substeps), 1, 0.1,
                 "some contact is nearly always too stiff");
    test::report("unaccounted over the largest energy", parted.unaccounted, alike.unaccounted, alike.unaccounted,
                 "each body moves at most by the same share as without parts; with four times the share it is " +
                     std::to_string(longer.unaccounted));
    EXPECT_NEAR(static_cast<double>(parted.substeps), static_cast<double>(longer.substeps),
                0.2 * static_cast<double>(longer.substeps));
    EXPECT_GT(parted.parts, 0.9 * static_cast<double>(parts * parted.substeps));
    EXPECT_LT(parted.unaccounted, 2 * alike.unaccounted);
    EXPECT_GT(longer.unaccounted, 2 * alike.unaccounted) << "else the test tells nothing";
}

TYPED_TEST(FullSizeSubcycling, RocksOfTwoSizesComeToRest)
{
    constexpr double damped = 2.6, left = 0.5; // as in rocks_rest.cpp
    test::expect_rest(this->exec(),
                      two_sizes(0.4, 4) + test::phase("settle", 0.3, damped) + test::phase("rest", 0, left), damped,
                      left);
}

} // namespace
