#include <numbers>

#include "law_support.hpp"

// Volume gap at the apex: separated material must close before it carries load, and returns no energy.
namespace
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

MaterialParameters<double> sand(double friction, double dilation, double cohesion)
{
    return make_material(make_elasticity<double>(1e7, 0.25, 1500),
                         make_mohr_coulomb<double>({friction, dilation, cohesion}));
}

const char* rounding = "rounding of a hundred steps";

TEST(VolumeGap, DrySandCarriesOnlyWhenClosed)
{
    Element element{sand(35, 5, 0)};
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(1e-4, 1e-4, 1e-4)); }
    EXPECT_EQ(element.stress.norm(), 0);
    expect_law("log volume opened", element.state.volume_gap, 0.03, 1e-15, rounding);

    for (int i = 0; i < 99; ++i) { element.strain(diagonal(-1e-4, -1e-4, -1e-4)); }
    expect_law("stress while closing, Pa", element.stress.norm(), 0, 1e-8, rounding);
    for (int i = 0; i < 2; ++i) { element.strain(diagonal(-1e-4, -1e-4, -1e-4)); }
    const double bulk = element.material.bulk_modulus;
    expect_law("pressure beyond, Pa", -element.stress[0], bulk * 3e-4, 1e-9 * bulk * 3e-4, rounding);
    EXPECT_EQ(element.state.volume_gap, 0);
    expect_law("work of dry opening, J/m3", element.plastic_work, 0, 1e-12, "no stress, no work");
}

TEST(VolumeGap, LiquidHoldsNoTension)
{
    const auto elasticity = make_elasticity<double>(1e7, 0.499, 1500);
    const auto hexagon    = make_material(elasticity, make_mohr_coulomb<double>({0, 0, 0}));
    const auto cone       = make_material(elasticity, make_drucker_prager<double>({0, 0, 0}, ConeFit::compression));
    for (const auto& material : {hexagon, cone})
    {
        Element element{material};
        element.strain(diagonal(-1e-4, -3e-4, -2e-4));
        const double pressure = material.bulk_modulus * 6e-4;
        expect_law("pressure, Pa", -element.stress[0], pressure, 1e-12 * pressure, rounding);
        expect_law("shear stress, Pa", element.stress[0] - element.stress[1], 0, 1e-12 * pressure, rounding);
        for (int i = 0; i < 10; ++i) { element.strain(diagonal(2e-4, 1e-4, 3e-4)); }
        EXPECT_EQ(element.stress.norm(), 0);
        expect_law("log volume opened", element.state.volume_gap, 54e-4, 1e-12, rounding);
    }
}

TEST(VolumeGap, ApartGrainsDoNotDilate)
{
    Element element{sand(35, 20, 0)};
    element.strain(diagonal(1e-2, 0, 0));
    const double gap = element.state.volume_gap;
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(-2e-4, 1e-4, 1e-4)); }
    expect_law("stress of sheared open sand, Pa", element.stress.norm(), 0, 1e-8, rounding);
    expect_law("gap after isochoric shear", element.state.volume_gap, gap, 1e-14, rounding);
    EXPECT_GT(element.state.plastic_shear, 1e-2);
}

TEST(VolumeGap, CohesiveSandPaysForOpeningAndGainsNothing)
{
    Element      element{sand(15, 0, 600)};
    const double apex = 600 / std::tan(15 * std::numbers::pi / 180), bulk = element.material.bulk_modulus;
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(1e-4, 1e-4, 1e-4)); }
    expect_law("tension at the apex, Pa", element.stress[0], apex, 1e-9 * apex,
               "c cot phi; 2239 Pa of verification docs/verification.md#yield-surface");
    EXPECT_NEAR(apex, 2239, 0.5);
    expect_law("log volume opened", element.state.volume_gap, 0.03 - apex / bulk, 1e-13, rounding);
    const double opening = element.plastic_work;
    expect_law("work of opening, J/m3", opening, apex * (0.03 - apex / bulk), 1e-9 * opening, rounding);

    for (int i = 0; i < 100; ++i)
    {
        element.strain(diagonal(-1e-4, -1e-4, -1e-4));
        EXPECT_GE(element.plastic_work, opening);
    }
    // The strain is back at zero, and so is the stress: the gap was closed, and the stretch unloaded.
    expect_law("stress at zero strain, Pa", element.stress.norm(), 0, 1e-6, rounding);
    expect_law("gap at zero strain", element.state.volume_gap, 0, 1e-12, rounding);
    element.strain(diagonal(-1e-4, -1e-4, -1e-4));
    expect_law("pressure beyond, Pa", -element.stress[0], bulk * 3e-4, 1e-6, rounding);
}

TEST(VolumeGap, WorkOfARandomPathIsStoredOrDissipated)
{
    Random  random(9);
    Element element{sand(30, 10, 50)};
    double  supplied = 0, worst = 0;
    for (int n = 0; n < 200000; ++n)
    {
        Sym3<double> strain;
        for (int c = 0; c < 6; ++c) { strain[c] = random.uniform(-1e-5, 1e-5); }
        const Sym3<double> before = element.stress;
        const double       done   = element.plastic_work;
        element.strain(strain);
        supplied += full_matrix(Sym3<double>(0.5 * (before + element.stress))).cwiseProduct(full_matrix(strain)).sum();
        worst = std::max(worst, done - element.plastic_work);
    }
    const double stored = elastic_energy_density(element.material, element.stress);
    std::printf("  supplied %.6g J/m3, stored %.3g, plastic work %.6g\n", supplied, stored, element.plastic_work);
    expect_below("negative plastic work of a step, J/m3", worst, 1e-15, "rounding of stress x strain = 1e2 x 1e-5");
    expect_below("unaccounted over supplied", std::abs(supplied - stored - element.plastic_work) / supplied, 1e-3,
                 "work by the mean stress of a step, plastic work by its last: half a step apart");
    EXPECT_GT(element.plastic_work, stored) << "the path must flow";
}

} // namespace
