#include <numbers>

#include "law_support.hpp"

// Element tests with closed forms: triaxial, oedometric and simple shear of a Mohr-Coulomb material.
namespace law_paths_test
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

const char* exact = "exact return: rounding, and a solved component to 1e-12";

struct Sand
{
    double friction, dilation, cohesion, young, poisson;

    double sine() const { return std::sin(friction * std::numbers::pi / 180); }
    double dilation_angle() const { return dilation * std::numbers::pi / 180; }
    double flow_number() const { return (1 + sine()) / (1 - sine()); }
    double dilation_number() const { return (1 + std::sin(dilation_angle())) / (1 - std::sin(dilation_angle())); }
    MaterialParameters<double> parameters() const
    {
        return make_material(make_elasticity<double>(young, poisson, 1500),
                             make_mohr_coulomb<double>({friction, dilation, cohesion}));
    }
};

constexpr Sand sands[] = {{35, 5, 0, 1e6, 0.3}, {29, 0, 0, 1e7, 0.25}, {15, 0, 100, 5e5, 0.3}, {30, 0, 0, 1e7, 0.3}};

/// Axial strain along z in steps at a constant cell pressure.
struct Triaxial
{
    Triaxial(const Sand& sand, double cell)
        : element{sand.parameters()}
        , pressure(cell)
    {
        element.stress = diagonal(-cell, -cell, -cell);
    }

    /// Returns the lateral strain.
    double step(double axial)
    {
        return element.strain_holding(diagonal(0, 0, axial), diagonal(1, 1, 0), 0, -pressure, 10 * std::abs(axial));
    }

    Element element;
    double  pressure;
};

TEST(MohrCoulombPath, TriaxialCompression)
{
    for (const Sand& sand : sands)
    {
        for (const double cell : {1e3, 1e4})
        {
            Triaxial     test(sand, cell);
            const double n = sand.flow_number(), ultimate = n * cell + 2 * sand.cohesion * std::sqrt(n);
            const double yield = (ultimate - cell) / sand.young, step = yield / 100;
            double       lateral = 0;
            for (int i = 0; i < 99; ++i) { lateral = test.step(-step); }
            expect_law("q before yield, Pa", -test.element.stress[2] - cell, 0.99 * (ultimate - cell), 1e-9 * ultimate,
                       exact);
            EXPECT_EQ(test.element.state.plastic_shear, 0);
            expect_law("elastic lateral strain", lateral / step, sand.poisson, 1e-9, exact);
            for (int i = 0; i < 101; ++i) { lateral = test.step(-step); }
            expect_law("compressive strength, Pa", -test.element.stress[2], ultimate, 1e-9 * ultimate, exact);
            expect_law("d eps_v / d eps_1", 1 - 2 * lateral / step, 1 - sand.dilation_number(), 1e-9, exact);
        }
    }
}

TEST(MohrCoulombPath, TriaxialExtension)
{
    for (const Sand& sand : sands)
    {
        Triaxial     test(sand, 1e3);
        const double n = sand.flow_number(), ultimate = (1e3 - 2 * sand.cohesion * std::sqrt(n)) / n;
        for (int i = 0; i < 200; ++i) { test.step((1e3 - ultimate) / sand.young / 100); }
        expect_law("extensive strength, Pa", -test.element.stress[2], ultimate, 1e-9 * 1e3, exact);
    }
}

TEST(MohrCoulombPath, TriaxialPlasticWorkIsWhatTheStrainDoes)
{
    // The stress is constant on the yield surface, so that all work of the strain is plastic.
    Triaxial test(sands[0], 1e3);
    for (int i = 0; i < 100; ++i) { test.step(-1e-4); }
    const double before = test.element.plastic_work, shear = test.element.state.plastic_shear;
    const double lateral = test.step(-1e-4);
    const double work    = test.element.stress[2] * -1e-4 + 2 * test.element.stress[0] * lateral;
    expect_law("plastic work, J/m3", test.element.plastic_work - before, work, 1e-9 * work, exact);
    expect_law("equivalent plastic shear", test.element.state.plastic_shear - shear, 2.0 / 3.0 * (1e-4 + lateral),
               1e-13, "sqrt(2/3 e:e) of an axial and two equal lateral strains");
}

TEST(MohrCoulombPath, OedometerWithActivePressureAboveElastic)
{
    const Sand   sand{25, 1, 0, 5e6, 0.25};
    const double n = sand.flow_number(), m = sand.dilation_number();
    const double modulus = sand.young / (1 - 2 * sand.poisson / n + 2 / m * ((1 - sand.poisson) / n - sand.poisson));
    Element      element{sand.parameters()};
    for (int i = 0; i < 100; ++i) { element.strain(diagonal(0, 0, -1e-5)); }
    expect_law("modulus of the closed form, Pa", modulus, 5.54246e6, 5, "given to six digits");
    expect_law("sigma_z, Pa", -element.stress[2], modulus * 1e-3, 1e-8 * modulus * 1e-3, exact);
    expect_law("sigma_r, Pa", -element.stress[0], modulus * 1e-3 / n, 1e-8 * modulus * 1e-3, exact);
    expect_law("K = Ka", element.stress[0] / element.stress[2], (1 - sand.sine()) / (1 + sand.sine()), 1e-9, exact);
}

/// Confined compression from zero stress: elastic with K0 if K0 >= Ka, and for Ka > K0 along the edge of two active
/// planes from sigma_z = 2 c sqrt(Ka) / (Ka - K0) on, with K from sigma_r = Ka sigma_z - 2 c sqrt(Ka).
TEST(MohrCoulombPath, OedometerOfEveryParameterSet)
{
    for (const Sand& sand : sands)
    {
        const double n = sand.flow_number(), m = sand.dilation_number(), nu = sand.poisson, ka = 1 / n;
        const double elastic = sand.young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), k0 = nu / (1 - nu);
        const bool   flows   = ka > k0;
        const double onset   = flows ? 2 * sand.cohesion * std::sqrt(ka) / (ka - k0) : 0;
        const double plastic = sand.young / (1 - 2 * nu / n + 2 / m * ((1 - nu) / n - nu));
        const double end     = flows ? 2 * onset + 1e4 : 1e4;
        const double strain  = flows ? onset / elastic + (end - onset) / plastic : end / elastic;
        Element      element{sand.parameters()};
        for (int i = 0; i < 1000; ++i) { element.strain(diagonal(0, 0, -strain / 1000)); }
        // In the step of first yield only the excess is plastic; the return accounts for that.
        expect_law("sigma_z, Pa", -element.stress[2], end, 1e-8 * end, exact);
        const double side = flows ? ka * end - 2 * sand.cohesion * std::sqrt(ka) : k0 * end;
        expect_law("sigma_r, Pa", -element.stress[0], side, 1e-8 * end, exact);
        EXPECT_EQ(element.state.plastic_shear > 0, flows);
    }
}

/// Simple shear in xz at constant sigma_z, plane strain in y, from the K0 state.
TEST(MohrCoulombPath, SimpleShearReachesDavis)
{
    for (const Sand& sand : sands)
    {
        const double normal = 1e3, k0 = sand.poisson / (1 - sand.poisson), step = 1e-2 * normal / sand.young;
        Element      element{sand.parameters()};
        element.stress     = diagonal(-k0 * normal, -k0 * normal, -normal);
        Sym3<double> shear = Sym3<double>::Zero();
        shear[4]           = 0.5 * step;
        double rise = 0, first_yield = 0;
        for (int i = 0; i < 4000; ++i)
        {
            if (element.state.plastic_shear == 0) { first_yield = element.stress[4] / normal; }
            rise = element.strain_holding(shear, diagonal(0, 0, 1), 2, -normal, 10 * step);
        }
        const double psi      = sand.dilation_angle();
        const double per_unit = std::cos(psi) / (1 - sand.sine() * std::sin(psi));
        const double davis =
            (sand.sine() + sand.cohesion * std::sqrt(1 - sand.sine() * sand.sine()) / normal) * per_unit;
        expect_law("ultimate tau / sigma_n", element.stress[4] / normal, davis, 1e-6,
                   "approached exponentially over 40 yield strains");
        expect_law("d eps_v / d gamma", rise / step, std::tan(psi), 1e-6, "the same");
        if (sand.cohesion > 0) { continue; }
        const double radius = (1 + k0) / 2 * sand.sine(), offset = (1 - k0) / 2;
        if (radius <= offset) { continue; } // K0 state already yields
        const double yield = std::sqrt(radius * radius - offset * offset);
        expect_law("tau / sigma_n at first yield", first_yield,
                   yield - 0.5 * step * sand.parameters().shear_modulus / normal,
                   0.5 * step * sand.parameters().shear_modulus / normal, "yield falls within one step, from below");
    }
}

} // namespace law_paths_test
