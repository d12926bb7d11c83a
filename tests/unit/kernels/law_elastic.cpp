#include <cmath>
#include <cstdio>
#include <numbers>

#include "kernels/mpm/laws/mid_step_kern.hpp"
#include "law_support.hpp"

// Objectivity, Hooke's law and its energy.
namespace
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

template<class Real>
MaterialParameters<Real> rubber()
{
    return make_material(make_elasticity<Real>(1e7, 0.25, 2000));
}

Sym3<double> some_stress()
{
    Sym3<double> stress;
    stress << -1000, -3500, -9000, 700, -300, 1200;
    return stress;
}

template<class Real>
Sym3<Real> turned(int steps, double angle)
{
    const Vec3<double> axis = Vec3<double>(1, 2, -0.5).normalized();
    Mat3<double>       spin;
    spin << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
    // Cayley's formula rotates by 2 atan(|w| dt / 2) per step.
    const Mat3<Real> gradient = (2 * std::tan(0.5 * angle / steps) * spin).template cast<Real>();
    Sym3<Real>       stress   = some_stress().template cast<Real>();
    for (int n = 0; n < steps; ++n)
    {
        stress = update_stress(rubber<Real>(), stress, PlasticState<Real>{}, gradient, Real(1)).stress;
    }
    return stress;
}

TEST(ElasticLaw, TenTurnsBringTheStressBack)
{
    const Sym3<double> start = some_stress();
    const double       size  = full_matrix(start).norm();
    for (const int steps : {40, 1000, 62832})
    {
        const double turn = 20 * std::numbers::pi;
        const double off  = (full_matrix(turned<double>(steps, turn)) - full_matrix(start)).norm() / size;
        expect_below("double, error after 10 turns in " + std::to_string(steps), off, 1e-15 * steps,
                     "one rounding a step, all one way");
        const Mat3<double> single = full_matrix(Sym3<double>(turned<float>(steps, turn).cast<double>()));
        expect_below("float, change of |stress|", std::abs(single.norm() / size - 1), 6e-8 * 8 * std::sqrt(steps),
                     "some four roundings of 6e-8 a step add as a random walk; four deviations");
    }
}

TEST(ElasticLaw, QuarterTurnTurnsTheStress)
{
    Mat3<double> gradient = Mat3<double>::Zero();
    gradient(0, 1)        = -2; // w dt = 2: atan(1) = 45 degrees twice
    gradient(1, 0)        = 2;
    const auto stress =
        update_stress(rubber<double>(), diagonal(5, 3, 1), PlasticState<double>{}, gradient, 1.0).stress;
    EXPECT_LT((stress - diagonal(3, 5, 1)).norm(), 1e-14) << "exact but for rounding";
}

TEST(ElasticLaw, ModuliOfHooke)
{
    const double young = 1e7, poisson = 0.25, e = 1e-4;
    const auto   strained = [&](const Mat3<double>& gradient) {
        return update_stress(rubber<double>(), Sym3<double>::Zero().eval(), PlasticState<double>{}, gradient, 1.0)
            .stress;
    };
    const char* exact = "exact but for rounding";

    Mat3<double> gradient = Mat3<double>::Zero();
    gradient.diagonal() << e, -poisson * e, -poisson * e;
    expect_law("uniaxial stress, Pa", strained(gradient)[0], young * e, 1e-12 * young * e, exact);
    expect_law("lateral stress, Pa", strained(gradient)[1], 0, 1e-12 * young * e, exact);

    gradient        = Mat3<double>::Zero();
    gradient(0, 1)  = e;
    const double mu = young / (2 * (1 + poisson));
    EXPECT_NEAR(strained(Mat3<double>(gradient + gradient.transpose()))[5], 2 * mu * e, 1e-12 * mu * e);
    expect_law("shear stress, Pa", strained(gradient)[5], mu * e, 1e-12 * mu * e, exact);
    expect_law("wave speed, m/s", rubber<double>().wave_speed, std::sqrt(1.2 * young / 2000), 1e-10, exact);
}

TEST(ElasticLaw, EnergyIsTheWorkOfTheStrain)
{
    const auto   material = rubber<double>();
    Random       random(3);
    Sym3<double> strain;
    for (int c = 0; c < 6; ++c) { strain[c] = random.uniform(-1e-3, 1e-3); }
    const Sym3<double> stress = elastic_stress(material, strain);
    const double       work   = 0.5 * full_matrix(stress).cwiseProduct(full_matrix(strain)).sum();
    expect_law("energy density, J/m3", elastic_energy_density(material, stress), work, 1e-13 * work,
               "exact but for rounding");
}

TEST(ElasticLaw, PlasticStateComesBackAsItWent)
{
    const PlasticState<float> state{0.25f, 3.0f, 0.125f};
    const auto                update =
        update_stress(rubber<float>(), Sym3<float>::Ones().eval(), state, Mat3<float>::Random().eval(), 1e-3f);
    EXPECT_EQ(update.state.plastic_shear, state.plastic_shear);
    EXPECT_EQ(update.state.plastic_rate, state.plastic_rate);
    EXPECT_EQ(update.state.volume_gap, state.volume_gap);
    EXPECT_EQ(update.plastic_work, 0);
}

/// Straight steps that rotate by atan(a) stretch by sqrt(1 + a^2) across the axis, steps along a line by 1 + a: the
/// gradient at the middle of the step gives this, that at the start does not.
TEST(MidStep, StraightStepsAreSeenAsTheyStrain)
{
    for (const double a : {1e-3, 1e-2, 0.1})
    {
        Mat3<double> turn = Mat3<double>::Zero(), stretch = Mat3<double>::Zero();
        turn(0, 1)            = -a;
        turn(1, 0)            = a;
        stretch(2, 2)         = a;
        const auto   turned   = strain_increment(Mat3<double>(turn + to_mid_step(turn, 1.0)), 1.0);
        const auto   drawn    = strain_increment(Mat3<double>(stretch + to_mid_step(stretch, 1.0)), 1.0);
        const double swelling = 0.5 * std::log1p(a * a);
        std::printf("[ measured ] strain of a turn by %.3f: %.8e, expected %.8e, tolerance %.1e = a^4/3 (two terms)\n",
                    a, turned[0], swelling, a * a * a * a / 3);
        EXPECT_NEAR(turned[0], swelling, a * a * a * a / 3);
        EXPECT_NEAR(turned[1], swelling, a * a * a * a / 3);
        EXPECT_NEAR(drawn[2], std::log1p(a), a * a * a / 3);
        const Mat3<double> both = turn + 0.3 * stretch + 0.2 * turn * stretch.transpose();
        EXPECT_NEAR(divergence_to_mid_step(both, 0.7), to_mid_step(both, 0.7).trace(), 1e-15 * a);
    }
}

} // namespace
