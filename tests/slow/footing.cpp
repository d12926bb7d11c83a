#include "footing.hpp"

// Footings too large for the quick tests (verification C4).
namespace
{

using namespace tread;

template<class Exec>
class FootingSlow : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FootingSlow, test::Backends, test::BackendNames);

/// Weightless clay, c = 1 kPa: q = (2 + pi) c.
test::Footing clay(int cells, const std::string& volume_strain)
{
    test::Footing footing;
    footing.soil          = R"(model = "mohr-coulomb"
young = 1.0e6
poisson = 0.49
friction_angle_deg = 0.0
cohesion = 1000.0)";
    footing.cells         = cells;
    footing.volume_strain = volume_strain;
    footing.settlement    = 0.04;
    footing.speed         = 0.01;
    return footing;
}

constexpr double prandtl = 5141.6; // Pa

void print(const std::string& what, const std::vector<test::FootingLoad>& loads)
{
    std::cout << "  " << what << ", settlement / B: pressure in Pa:";
    for (const auto& load : loads) { std::cout << " " << load.settlement << ": " << load.pressure; }
    std::cout << std::endl;
}

TYPED_TEST(FootingSlow, UndrainedClayComesCloserToPrandtlWithCellAverages)
{
    double over[2] = {};
    int    at      = 0;
    for (const int cells : {5, 10})
    {
        const auto loads = test::FootingTest<TypeParam>(this->exec(), clay(cells, "cell-average")).run(12);
        print("clay, cell averages, B/" + std::to_string(2 * cells), loads);
        over[at++]        = loads.back().pressure / prandtl - 1;
        const double rise = loads.back().pressure / loads[8].pressure - 1;
        test::report("rise over the last quarter of the settlement", rise, 0, 0.02, "at most: a plateau");
        EXPECT_LT(rise, 0.02);
    }
    test::report("over-prediction at B/20", over[1], 0, over[0], "less than at B/10, and no less than nothing");
    EXPECT_LT(over[1], over[0]);
    EXPECT_GT(over[1], 0);
}

} // namespace
