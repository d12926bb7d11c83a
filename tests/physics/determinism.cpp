#include <omp.h>

#include "harness.hpp"
#include "thrown_roller.hpp"

namespace
{

using namespace tread;

const std::string mixed_text = test::sand_text + test::rocks_text + test::thrown_roller_text;

/// Positions of points and bodies after the 0.05 s of the scene.
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
