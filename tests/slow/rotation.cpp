#include <cmath>
#include <string>

#include <fmt/format.h>

#include "../physics/turning_body.hpp"

// Twenty seconds of rotation; the soft disc's two turns are in tests/physics.
namespace
{

using namespace tread;

template<class Exec>
class SlowRotation : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(SlowRotation, test::Backends, test::BackendNames);

const std::string square = "region = { box = [[0.4, 0.0, 0.4], [1.2, 0.05, 1.2]] }"; // of 16 x 16 cells
const std::string little = "region = { box = [[0.7, 0.0, 0.7], [0.9, 0.05, 0.9]] }"; // of 4 x 4 cells

/// At 1/s: with the strain at the start of the step the area would grow by rate^2 dt per second, 9.3e-3 in 19 s, and
/// the kinetic energy fall as much. The first second is left out, in which the transient of the unstressed start
/// decays. The little square uses APIC, because AFLIP's filter dissipates 1.5e-2 at the rim of so few cells.
TYPED_TEST(SlowRotation, SquareKeepsItsEnergyAndTheBalanceCloses)
{
    struct Case
    {
        const std::string& shape;
        const char*        numerics;
    };
    for (const Case& c :
         {Case{square, "transfer = \"aflip\""}, Case{little, "transfer = \"apic\"\nvolume_strain = \"cell-average\""}})
    {
        test::Experiment<TypeParam> run(this->exec(), test::turning_text(c.shape, c.numerics, 0x1p-11, 20));
        test::set_turning(run, 1);
        double start = 0;
        run.run(
            [&](double time)
            {
                if (start == 0 && time >= 1) { start = run.simulation().census().sand.kinetic; }
            });
        const solver::Census now = run.simulation().census();
        run.simulation().ledger().energy(now);
        const double lost = 1 - now.sand.kinetic / start, unaccounted = run.simulation().ledger().errors().energy;
        test::report(fmt::format("kinetic energy lost from 1 to 20 s, {}", c.numerics), lost, 0, 1e-3,
                     "a tenth of what the swelling of straight steps costs");
        test::report("unaccounted over the largest energy", unaccounted, 0, test::closes, "design 7");
        EXPECT_LE(std::abs(lost), 1e-3);
        EXPECT_NEAR(unaccounted, 0, test::closes);
    }
}

} // namespace
