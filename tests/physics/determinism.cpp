#include <omp.h>

#include "harness.hpp"

namespace
{

using namespace tread;

const std::string mixed_text = test::sand_text + test::rocks_text + R"(
[[material]]
name    = "steel"
model   = "elastic"
density = 7800.0
young   = 1.0e9
poisson = 0.3
[[shape]]
name      = "roller"
generate  = { kind = "wheel", radius = 0.1, width = 0.15, wall_thickness = 0.04, grousers = 6 }
sdf_cells = 48
[[body]]
name     = "roller"
shape    = "roller"
material = "steel"
mass     = 6.0
velocity = [0.2, 0.0, -1.0]
position = [0.2, 0.2, 0.32]
)";

/// Positions of points and bodies after the scene's 0.05 s.
template<class Exec>
std::vector<double> final_positions(const Exec& exec)
{
    test::Experiment<Exec, float> impact(exec, mixed_text);
    impact.run();
    std::vector<double> positions = impact.simulation().point_fields().position;
    const auto          bodies    = impact.simulation().body_fields().position;
    positions.insert(positions.end(), bodies.begin(), bodies.end());
    return positions;
}

template<class Exec>
class Determinism : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Determinism, test::Backends, test::BackendNames);

TYPED_TEST(Determinism, TwoRunsGiveTheSameBits)
{
    const auto first = final_positions(this->exec());
    EXPECT_EQ(first, final_positions(this->exec()));
}

TEST(DeterminismOfThreads, DoesNotChangeABit)
{
    Counters  counters;
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const auto one = final_positions(Cpu{&counters});
    omp_set_num_threads(3);
    const auto three = final_positions(Cpu{&counters});
    omp_set_num_threads(before);
    EXPECT_EQ(one, three);
}

} // namespace
