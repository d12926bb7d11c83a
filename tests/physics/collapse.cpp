#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>

#include "harness.hpp"

// Columns of sand, one cell thick, that collapse over a rough floor (verification C5).
namespace
{

using namespace tread;

template<class Exec>
class Collapse : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Collapse, test::Backends, test::BackendNames);

constexpr double width = 0.1; ///< m, of the column at the start

/// `aspect` = height over width; the wall at x = 0 is smooth, as the gate's opposite was.
std::string column_text(double aspect, int cells)
{
    const double spacing = width / cells, height = aspect * width;
    const double reach =
        std::ceil((width * (1 + std::max(1.2 * aspect, 1.9 * std::pow(aspect, 2.0 / 3))) + 0.1) / spacing);
    return fmt::format(R"(
title = "column collapse"
[domain]
size    = [{0}, {1}, {2}]
gravity = [0.0, 0.0, -9.81]
walls   = {{ x = "slip", y = "slip", bottom = "fixed", top = "open" }}
[grid]
spacing = {1}
[numerics]
precision = "double"
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = 3.0e5
poisson = 0.3
friction_angle_deg = 33.0
[[terrain]]
material = "sand"
region = {{ box = [[0.0, 0.0, 0.0], [{3}, {1}, {4}]] }}
[[phase]]
name = "collapse"
duration = {5}
)",
                       reach * spacing, spacing, std::ceil(height / spacing + 4) * spacing, width, height,
                       4.5 * std::sqrt(height / 9.81));
}

/// What is left when it has come to rest, over the initial width.
struct Deposit
{
    double front;  ///< where 99 % of the mass end
    double toe;    ///< where the deposit ends that is at least a point layer deep
    double height; ///< of the sand at the wall
    double speed;  ///< m/s, mean
};

template<class Exec>
Deposit collapse(const Exec& exec, double aspect, int cells)
{
    test::Experiment<Exec> experiment(exec, column_text(aspect, cells));
    experiment.run();
    const double        spacing = width / cells;
    auto                places  = experiment.simulation().sand().positions();
    std::vector<double> x;
    std::vector<int>    points_in(10000, 0);
    double              top = 0;
    for (const Vec3<double>& place : places)
    {
        x.push_back(place[0]);
        ++points_in[static_cast<std::size_t>(place[0] / spacing)];
        if (place[0] < spacing) { top = std::max(top, place[2] + 0.25 * spacing); }
    }
    std::sort(x.begin(), x.end());
    std::size_t toe = 0;
    while (points_in[toe] >= 4) { ++toe; }
    const double kinetic = experiment.simulation().census().sand.kinetic;
    return {x[static_cast<std::size_t>(0.99 * static_cast<double>(x.size()))] / width, double(toe) * spacing / width,
            top / width, std::sqrt(2 * kinetic / experiment.simulation().census().sand.mass)};
}

TYPED_TEST(Collapse, Probe)
{
    const int cells = std::getenv("CELLS") ? std::atoi(std::getenv("CELLS")) : 10;
    for (const double aspect : {0.6, 1.1, 3.0})
    {
        const Deposit left = collapse(this->exec(), aspect, cells);
        std::cout << fmt::format("a {} front {:.4f} toe {:.4f} height {:.4f} speed {:.3g}\n", aspect, left.front,
                                 left.toe, left.height, left.speed);
    }
}

} // namespace
