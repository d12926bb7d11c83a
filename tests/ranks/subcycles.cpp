#include <algorithm>
#include <cstdio>
#include <set>

#include "physics/rock_scenes.hpp"
#include "side_by_side.hpp"

// Rocks that move in parts of the substeps (docs/theory.md#subcycles) on several ranks, compared with the same on one.
namespace subcycles_ranks_test
{

using namespace tread;

std::string spheres(int count, double diameter, const Vec3<double>& low, const Vec3<double>& high)
{
    return fmt::format(R"(
[[rocks]]
shape     = "sphere"
material  = "stone"
count     = {}
diameter  = {}
placement = "rain"
region    = {{ box = [[{}, {}, {}], [{}, {}, {}]] }}
)",
                       count, diameter, low[0], low[1], low[2], high[0], high[1], high[2]);
}

constexpr int large = 20; ///< number of large spheres

/// Spheres of two sizes that fall through each other onto what lies below `low` (m).
std::string two_sizes(const Vec3<double>& size, double low, int small)
{
    return test::stone(1e7, 0.5, 0.5) +
           "[[shape]]\nname = \"sphere\"\ngenerate = { kind = \"sphere\", nodes = 42 }\nsdf_cells = 20\n" +
           spheres(large, 0.06, {0, 0, low}, {size[0], size[1], low + 0.15}) +
           spheres(small, 0.025, {0, 0, low + 0.15}, {size[0], size[1], low + 0.2}) +
           "[time]\ncontact_share = 0.3\nsubcycles = 3\n";
}

template<class Exec>
class SubcyclesOnRanks : public test::BackendTest<Exec>
{
protected:
    static int ranks() { return test::world().size(); }

    /// Expects that the same bodies move in parts on all ranks together as alone; returns how many.
    static int compare_marks(test::SideBySide<Exec>& run)
    {
        EXPECT_EQ(run.alone.simulation().rigid().parts(), run.together.simulation().rigid().parts());
        if (run.alone.simulation().rigid().parts() == 1) { return 0; }
        const auto marked = [](solver::DemSolver<Exec>& rigid)
        {
            std::vector<double>             numbers;
            const std::vector<std::int32_t> marks = rigid.pairs().stiff.body.to_host();
            for (std::size_t row = 0; row < marks.size(); ++row)
            {
                if (marks[row] == 0) { continue; }
                numbers.push_back(static_cast<double>(rigid.numbers().number(static_cast<std::int64_t>(row))));
            }
            return numbers;
        };
        std::set<double> alone, together;
        for (const double number : marked(run.alone.simulation().rigid())) { alone.insert(number); }
        for (const auto& of_rank : decomp::gather_values(test::world(), marked(run.together.simulation().rigid())))
        {
            together.insert(of_rank.begin(), of_rank.end());
        }
        EXPECT_EQ(alone, together);
        return static_cast<int>(alone.size());
    }

    /// Runs both for `steps`, with so many rocks; places and velocities agree to `bound` (m, m/s).
    static void expect_as_alone(test::SideBySide<Exec>& run, int rocks, int steps, double bound)
    {
        int stiff = 0, whole = 0, ghosts = 0, parted = 0;
        for (int step = 0; step < steps; ++step)
        {
            run.advance();
            if (::testing::Test::HasFailure()) { return; }
            parted += run.together.simulation().rigid().parts() > 1 ? 1 : 0;
            if (step % 20 != 0) { continue; }
            const int marked = compare_marks(run);
            stiff            = std::max(stiff, marked);
            whole            = marked > 0 ? std::max(whole, rocks - marked) : whole;
            ghosts           = std::max(ghosts, test::compare_holders(run.together.simulation().rigid()));
        }
        const io::BodyFields one = run.alone.simulation().body_fields(), all = run.bodies_together();
        const double         places = test::difference(one.position, all.position, 1.0),
                     speeds         = test::difference(one.velocity, all.velocity, 1.0);
        std::printf("%d of %d steps in parts, up to %d of %d rocks move in them and up to %d at once, up to %d ghosts; "
                    "places differ by %.3g m, velocities by %.3g m/s, bound %.3g: rounding of sums in another order, "
                    "which impacts multiply\n",
                    parted, steps, stiff, rocks, whole, ghosts, places, speeds, bound);
        EXPECT_GT(parted, steps / 2);
        EXPECT_GT(stiff, 2);
        EXPECT_GT(whole, 2);
        EXPECT_TRUE(ranks() == 1 || ghosts > 0);
        EXPECT_LT(places, bound);
        EXPECT_LT(speeds, bound);
    }
};
TYPED_TEST_SUITE(SubcyclesOnRanks, test::Backends, test::BackendNames);

TYPED_TEST(SubcyclesOnRanks, RocksAlone)
{
    constexpr int      few = 2;
    const Vec3<double> size(0.4, 0.15, 0.6);
    const std::string  text =
        test::rock_domain(size, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"", "") +
        two_sizes(size, 0, few) + test::phase("fall", 0, 1);
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size, test::slabs(size[0], this->ranks()));
    this->expect_as_alone(run, large + few, 200, 1e-9);
}

TYPED_TEST(SubcyclesOnRanks, RocksOnSand)
{
    constexpr int      many = 12;
    const Vec3<double> size(0.4, 0.4, 0.6);
    const std::string  text = std::string(test::sand_text) + "[numerics]\nprecision = \"double\"\n" +
                             two_sizes(size, 0.21, many) + test::phase("lie", 0, 1.0);
    test::SideBySide<TypeParam> run(this->exec(), test::load_text(text), size,
                                    test::quarters({0.2, 0.2, 0}, this->ranks()));
    this->expect_as_alone(run, large + many, 200, 1e-9);
}

} // namespace subcycles_ranks_test
