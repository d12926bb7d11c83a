#include <cmath>
#include <ctime>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "base/random.hpp"
#include "kernels/mpm/laws/law_kern.hpp"
#include "kernels/mpm/laws/mid_step_kern.hpp"

// Compares stress measures on one point: figures of docs/stress_measure.md. A measure has a State<Real> and
// step(material, state, l), with l = velocity gradient x dt, and returns the Kirchhoff stress.
namespace
{

using namespace tread;
using namespace tread::mpm;

template<class Real>
using Law = MaterialParameters<Real>;

template<class Real>
struct TurnedState
{
    Sym3<Real>         stress = Sym3<Real>::Zero(); ///< Pa
    PlasticState<Real> plastic{};
};

/// The measure of tread: stress rotated by the Hughes-Winget increment.
struct HughesWinget
{
    static constexpr const char* name = "Hughes-Winget";
    template<class Real>
    using State = TurnedState<Real>;

    template<class Real>
    static void step(const Law<Real>& law, State<Real>& state, const Mat3<Real>& l)
    {
        const auto update = update_stress(law, state.stress, state.plastic, l, Real(1));
        state             = {update.stress, update.state};
    }
};

/// Hughes-Winget with l at the start of the step, as the grid gives it.
struct HughesWingetFromStart
{
    template<class Real>
    using State = TurnedState<Real>;

    template<class Real>
    static void step(const Law<Real>& law, State<Real>& state, const Mat3<Real>& l)
    {
        HughesWinget::step(law, state, Mat3<Real>(l + to_mid_step(l, Real(1))));
    }
};

template<class Real>
StressUpdate<Real> returned(const Law<Real>& law, const Sym3<Real>& trial, const PlasticState<Real>& plastic)
{
    if (law.law == LawKind::elastic) { return {trial, plastic, Real(0)}; }
    return respond(law, law.mohr_coulomb, trial, plastic, Real(1));
}

/// The explicit rate W s - s W.
struct Jaumann
{
    static constexpr const char* name = "Jaumann rate";
    template<class Real>
    using State = TurnedState<Real>;

    template<class Real>
    static void step(const Law<Real>& law, State<Real>& state, const Mat3<Real>& l)
    {
        const Mat3<Real> spin = Real(0.5) * (l - l.transpose());
        const Mat3<Real> p    = spin * full_matrix(state.stress);
        Sym3<Real>       turn;
        turn << 2 * p(0, 0), 2 * p(1, 1), 2 * p(2, 2), p(1, 2) + p(2, 1), p(0, 2) + p(2, 0), p(0, 1) + p(1, 0);
        const Sym3<Real> trial  = state.stress + (turn + elastic_stress(law, strain_increment(l, Real(1))));
        const auto       update = returned(law, trial, state.plastic);
        state                   = {update.stress, update.state};
    }
};

template<class Real>
struct HenckyState
{
    Sym3<Real>         stress = Sym3<Real>::Zero(); ///< Pa; derived from the rest
    Sym3<Real>         strain = Sym3<Real>::Zero(); ///< b_e - 1
    PlasticState<Real> plastic{};
};

template<class Real>
Sym3<Real> lower(const Mat3<Real>& m)
{
    Sym3<Real> s;
    s << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1);
    return s;
}

/// Logarithmic strain of b_e, stored as b_e - 1; Kirchhoff stress C : log(b_e)/2; f = 1 + l, as the points move.
struct Hencky
{
    static constexpr const char* name = "Hencky, b_e - 1";
    template<class Real>
    using State = HenckyState<Real>;

    template<class Real>
    static void advance(const Law<Real>& law, State<Real>& state, const Mat3<Real>& l)
    {
        const Mat3<Real>           e = full_matrix(state.strain), le = l * e, lt = l.transpose();
        const Mat3<Real>           change = l + lt + l * lt + le + le.transpose() + le * lt;
        const SymmetricEigen<Real> eigen  = symmetric_eigen(Sym3<Real>(state.strain + lower(change)));
        Vec3<Real>                 log;
        for (int i = 0; i < 3; ++i) { log[i] = Real(0.5) * std::log1p(eigen.values[i]); }
        Sym3<Real> principal         = Sym3<Real>::Zero();
        principal.template head<3>() = log;
        const auto       update      = returned(law, elastic_stress(law, principal), state.plastic);
        const Vec3<Real> tau         = update.stress.template head<3>();
        state.plastic                = update.state;
        const Real mean              = tau.sum() / Real(3);
        Vec3<Real> kept;
        for (int i = 0; i < 3; ++i)
        {
            const Real strain = (tau[i] - mean) / (2 * law.shear_modulus) + mean / (3 * law.bulk_modulus);
            kept[i]           = std::expm1(2 * strain);
        }
        state.strain = from_principal(kept, eigen.axes);
        state.stress = from_principal(tau, eigen.axes);
    }

    template<class Real>
    static void step(const Law<Real>& law, State<Real>& state, const Mat3<Real>& l)
    {
        advance(law, state, l);
    }
};

/// Hencky with f = (1 - l/2)^-1 (1 + l/2), which is a rotation if l is skew.
struct HenckyMidpoint
{
    static constexpr const char* name = "Hencky, midpoint";
    template<class Real>
    using State = HenckyState<Real>;

    template<class Real>
    static void step(const Law<Real>& law, State<Real>& state, const Mat3<Real>& l)
    {
        const Mat3<Real> half = Mat3<Real>::Identity() - Real(0.5) * l;
        Hencky::advance(law, state, Mat3<Real>(half.inverse() * l));
    }
};

template<class Real>
void set_stress(const Law<Real>&, TurnedState<Real>& state, const Vec3<double>& stress)
{
    state = {};
    for (int i = 0; i < 3; ++i) { state.stress[i] = static_cast<Real>(stress[i]); }
}

template<class Real>
void set_stress(const Law<Real>& law, HenckyState<Real>& state, const Vec3<double>& stress)
{
    state             = {};
    const double mean = stress.sum() / 3;
    for (int i = 0; i < 3; ++i)
    {
        const double strain =
            (stress[i] - mean) / (2 * double(law.shear_modulus)) + mean / (3 * double(law.bulk_modulus));
        state.strain[i] = static_cast<Real>(std::expm1(2 * strain));
        state.stress[i] = static_cast<Real>(stress[i]);
    }
}

template<class Real>
Law<Real> rubber()
{
    return make_material(make_elasticity<Real>(1e6, 0.3, 1600));
}

template<class Real>
Law<Real> sand()
{
    return make_material(make_elasticity<Real>(1e6, 0.3, 1600), make_mohr_coulomb<Real>({35, 0, 0}));
}

template<class Measure, class Real>
typename Measure::template State<Real> start(const Law<Real>& law, const Vec3<double>& stress)
{
    typename Measure::template State<Real> state;
    set_stress(law, state, stress);
    return state;
}

/// Deviation from the initial stress after ten turns about an oblique axis, over the stress.
template<class Measure, class Real>
double ten_turns(int steps_a_turn)
{
    const auto         law  = rubber<Real>();
    const Vec3<double> axis = Vec3<double>(1, 2, -0.5).normalized(), stress(-1000, -3500, -9000);
    const double       w    = 2 * std::numbers::pi / steps_a_turn;
    Mat3<double>       spin;
    spin << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
    // Measures with Cayley's formula turn by 2 atan(w/2): w is chosen so that the turns are whole.
    const bool       cayley = std::is_same_v<Measure, HughesWinget> || std::is_same_v<Measure, HenckyMidpoint>;
    const Mat3<Real> l      = ((cayley ? 2 * std::tan(w / 2) : w) * spin).template cast<Real>();
    auto             state  = start<Measure>(law, stress);
    for (int n = 0; n < 10 * steps_a_turn; ++n) { Measure::step(law, state, l); }
    Sym3<double> off = state.stress.template cast<double>();
    off.template head<3>() -= stress;
    return full_matrix(off).norm() / stress.norm();
}

/// Shear stress over G after a simple shear to `gamma`, elastic.
template<class Measure>
double simple_shear(double gamma, int steps)
{
    const auto   law   = rubber<double>();
    auto         state = start<Measure>(law, Vec3<double>::Zero());
    Mat3<double> l     = Mat3<double>::Zero();
    l(0, 1)            = gamma / steps;
    for (int n = 0; n < steps; ++n) { Measure::step(law, state, l); }
    return state.stress[5] / law.shear_modulus;
}

/// Work of a closed strain cycle (stretch, shear, back, back) of this amplitude, over the largest energy in it.
template<class Measure>
double cycle_work(double amplitude, int steps)
{
    const auto   law   = rubber<double>();
    auto         state = start<Measure>(law, Vec3<double>::Zero());
    Mat3<double> f     = Mat3<double>::Identity();
    double       work = 0, largest = 0;
    const double corner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    for (int side = 0; side < 4; ++side)
    {
        for (int n = 1; n <= steps; ++n)
        {
            const double share = double(n) / steps;
            Mat3<double> next  = Mat3<double>::Identity();
            next(0, 0) += amplitude * (corner[side][0] + share * (corner[side + 1][0] - corner[side][0]));
            next(0, 1) += amplitude * (corner[side][1] + share * (corner[side + 1][1] - corner[side][1]));
            // Gradient at the midpoint, whose Cayley map is the increment of f.
            const Mat3<double> middle = 0.5 * (f + next), l = (next - f) * middle.inverse();
            const Mat3<double> plain  = (next - f) * f.inverse();
            const Sym3<double> before = state.stress;
            Measure::step(law, state, std::is_same_v<Measure, Hencky> ? plain : l);
            const Mat3<double> mean = full_matrix(Sym3<double>(0.5 * (before + state.stress)));
            work += mean.cwiseProduct(0.5 * (l + l.transpose())).sum();
            largest = std::max(largest, work);
            f       = next;
        }
    }
    return work / largest;
}

/// tau / sigma_n of sand in simple shear at constant volume to `gamma`, from an isotropic 1 kPa.
template<class Measure>
double sheared_sand(double gamma, int steps)
{
    const auto   law   = sand<double>();
    auto         state = start<Measure>(law, Vec3<double>(-1e3, -1e3, -1e3));
    Mat3<double> l     = Mat3<double>::Zero();
    l(0, 1)            = gamma / steps;
    for (int n = 0; n < steps; ++n) { Measure::step(law, state, l); }
    return -state.stress[5] / state.stress[1];
}

/// ns per step and point on one core: `strain` per step about a pressure of 1 kPa, each point with its own gradient.
template<class Measure, class Real>
double cost(const Law<Real>& law, double strain)
{
    constexpr std::size_t                               count  = 4096;
    constexpr int                                       rounds = 200;
    Random                                              random(1);
    std::vector<Mat3<Real>>                             gradients(count);
    std::vector<typename Measure::template State<Real>> states(count), first;
    for (std::size_t i = 0; i < count; ++i)
    {
        Mat3<double> l;
        for (int a = 0; a < 3; ++a)
        {
            for (int b = 0; b < 3; ++b) { l(a, b) = random.uniform(-strain, strain); }
        }
        gradients[i] = (l - l.trace() / 3 * Mat3<double>::Identity()).cast<Real>();
        set_stress(law, states[i], Vec3<double>(-1e3, -1e3, -1e3));
    }
    double best = 1e30;
    first       = states;
    for (int repeat = 0; repeat < 5; ++repeat)
    {
        states                  = first;
        const std::clock_t from = std::clock(); // of this process, because other processes use the machine too
        for (int n = 0; n < rounds; ++n)
        {
            for (std::size_t i = 0; i < count; ++i) { Measure::step(law, states[i], gradients[i]); }
        }
        best = std::min(best, double(std::clock() - from) / CLOCKS_PER_SEC);
    }
    return best * 1e9 / (rounds * count);
}

template<class Measure>
void print_cost(const char* what)
{
    fmt::print("  ns a point, {}: elastic {:.1f} (double) {:.1f} (single); yielding {:.1f} (double) {:.1f} (single)\n",
               what, cost<Measure, double>(rubber<double>(), 1e-6), cost<Measure, float>(rubber<float>(), 1e-6),
               cost<Measure, double>(sand<double>(), 1e-4), cost<Measure, float>(sand<float>(), 1e-4));
}

template<class Measure>
void print_measure()
{
    fmt::print("\n{}\n", Measure::name);
    for (const int steps : {100, 1000, 10000})
    {
        fmt::print("  10 turns, {:5} steps each: off by {:.2e} (double), {:.2e} (single)\n", steps,
                   ten_turns<Measure, double>(steps), ten_turns<Measure, float>(steps));
    }
    for (const double gamma : {0.01, 0.1, 1.0})
    {
        const double hencky = 4 * std::asinh(gamma / 2) / std::sqrt(4 + gamma * gamma);
        fmt::print(
            "  simple shear {:4}: tau/G {:.8f} (1000 steps), off Hencky's {:+.2e}, 100 steps off 10000 {:+.1e}\n",
            gamma, simple_shear<Measure>(gamma, 1000), simple_shear<Measure>(gamma, 1000) / hencky - 1,
            simple_shear<Measure>(gamma, 100) / simple_shear<Measure>(gamma, 10000) - 1);
    }
    for (const double amplitude : {1e-3, 1e-2, 1e-1})
    {
        fmt::print("  closed cycle of {:5}: work over largest energy {:+.2e}\n", amplitude,
                   cycle_work<Measure>(amplitude, 1000));
    }
    for (const int steps : {100, 10000})
    {
        fmt::print("  sand sheared to 1 in {:5} steps: tau/sigma_n {:.6f}\n", steps, sheared_sand<Measure>(1, steps));
    }
    print_cost<Measure>("from the gradient of the middle");
}

} // namespace

int main()
{
    print_measure<HughesWinget>();
    print_cost<HughesWingetFromStart>("from that of the start");
    print_measure<Jaumann>();
    print_measure<Hencky>();
    print_measure<HenckyMidpoint>();
    return 0;
}
