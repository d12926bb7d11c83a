#include <random>

#include "harness.hpp"

namespace
{

using namespace tread;

template<class Exec>
class CellMeans : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(CellMeans, test::Backends, test::BackendNames);

/// A free elastic block whose points have pressures of their own, as the flow of sand that dilates leaves them: what
/// the forces of the cells' mean pressure do is what the mean strains of the cells store.
TYPED_TEST(CellMeans, PressuresThatDifferWithinACellMakeNoEnergy)
{
    const std::string           text = R"(
title = "pressures that differ"
[domain]
size    = [0.6, 0.6, 0.6]
gravity = [0.0, 0.0, 0.0]
[grid]
spacing = 0.05
[time]
dt = 1.0e-5
[numerics]
precision     = "double"
transfer      = "flip"
pic_rate      = 0.0
volume_strain = "cell-average"
[[material]]
name    = "block"
model   = "elastic"
density = 1000.0
young   = 1.0e6
poisson = 0.3
[[terrain]]
material = "block"
region   = { box = [[0.2, 0.2, 0.2], [0.4, 0.4, 0.4]] }
[[phase]]
name     = "ring"
duration = 0.02
)";
    test::Experiment<TypeParam> block(this->exec(), text);
    auto&                       points = block.simulation().sand().points();
    auto                        stress = points.stress.to_host();
    const std::size_t           n      = stress.size() / 6;
    std::mt19937_64             random(7);
    std::uniform_real_distribution<double> pressure(0.0, 2.0e3);
    for (std::size_t i = 0; i < n; ++i)
    {
        const double own = pressure(random);
        for (std::size_t c = 0; c < 3; ++c) { stress[c * n + i] = -own; }
    }
    points.stress.assign(stress);
    const auto energy = [&]
    {
        const solver::SandCensus now = block.simulation().census().sand;
        return now.kinetic + now.strain;
    };
    const double start = energy();
    double       least = start, most = start, fastest = 0;
    int          step = 0;
    block.run(
        [&](double)
        {
            if (++step % 20 != 0) { return; }
            const double now = energy();
            least   = std::min(least, now);
            most    = std::max(most, now);
            fastest = std::max(fastest, block.simulation().census().sand.kinetic);
        });
    std::cout << start << " " << least << " " << most << " " << fastest << "\n";
    EXPECT_GT(fastest, 0.0);
}

} // namespace
