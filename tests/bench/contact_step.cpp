#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "physics/rock_rest.hpp"
#include "solver/bodies/dem_solver.hpp"

// Prints docs/studies/contact_step.csv: the largest stable substep of a settled, undamped pile, beside the estimates
// from contact stiffness and from Hertz's law.
namespace
{

using namespace tread;

constexpr int    count = 48, block = 10; ///< substeps between pair searches
constexpr double poisson = 0.25;         ///< of test::stone
constexpr double safety  = 0.2;          ///< of sqrt(m / sum K), as in the solver

struct Kind
{
    const char* name;
    const char* shape;
    double      closed_form; ///< 1, or 0: a generated sphere whose contacts use its nodes
};

/// A scene with the state of its bodies.
struct Pile
{
    scene::Scene scene;
    world::World world;
    double       unit; ///< J, m g R summed over bodies
};

Pile poured(const test::RockForms& forms, const Kind& kind)
{
    constexpr double width = 8 * test::rock_radius, height = 36 * test::rock_radius;
    std::string      text =
        test::rock_domain({width, width, height}, 0, "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"",
                          "linear_overlap = 1e-2") +
        test::stone(1e7, 0.5, 0.5) + forms.text();
    text += "\n[[shape]]\nname = \"sphere\"\ngenerate = { kind = \"sphere\", nodes = 162 }\nsdf_cells = 40\n";
    text += test::rocks_of(kind.shape, count, "rain", {0, 0, 0}, {width, width, height}) + test::phase("all", 0, 1);
    Pile pile{test::load_text(text), {}, 0};
    pile.world = world::build_world(pile.scene);
    for (scene::Contact& contact : pile.scene.contacts)
    {
        contact.rolling_friction = 0.05;
    } // otherwise balls keep rolling
    for (shape::ShapeTemplate& form : pile.world.templates) { form.sphere_radius *= kind.closed_form; }
    for (const double mass : pile.world.bodies.mass) { pile.unit += mass * test::earth * test::rock_radius; }
    return pile;
}

class Run
{
public:
    Run(const Cpu& cpu, const Pile& pile)
        : rigid_(cpu, pile.scene, pile.world, solver::make_plan(pile.scene, pile.world))
    {
    }

    solver::DemSolver<Cpu>& rigid() { return rigid_; }

    void advance(double dt, double damping)
    {
        rigid_.find_pairs(block * dt);
        for (int substep = 0; substep < block; ++substep)
        {
            rigid_.contact(dt);
            rigid_.move(dt, damping);
        }
    }

    double energy()
    {
        const solver::RigidCensus now = rigid_.census();
        return now.kinetic + now.contact + now.gravity;
    }

private:
    solver::DemSolver<Cpu> rigid_;
};

/// State of a pile at rest; time in s.
struct Rest
{
    double kinetic; ///< over m g R
    double contact; ///< s, least sqrt(m / sum K) as in the solver: of contacts that touch or are about to
};

/// Damps until the kinetic energy is below 1e-9 m g R, for at least `least` and at most `longest` (s). Bodies and
/// contacts of the pile are then at rest.
Rest settle(const Cpu& cpu, Pile& pile, double least, double longest)
{
    constexpr double free_flight = 1e-4, still = 1e-9, damping = 0.7;
    Run              run(cpu, pile);
    Rest             rest{1, 0};
    double           dt = 1e-7;
    for (double time = 0; time < least || (time < longest && rest.kinetic > still); time += block * dt)
    {
        rest.contact = run.rigid().shortest_contact();
        dt           = std::min(1.05 * dt, rest.contact > 0 ? safety * rest.contact : free_flight);
        run.advance(dt, damping);
        rest.kinetic = run.rigid().census().kinetic / pile.unit;
    }
    const io::BodyFields fields = run.rigid().fields();
    pile.world.contacts         = run.rigid().contacts();
    for (std::size_t b = 0; b < pile.world.bodies.size(); ++b)
    {
        const double* q                  = fields.orientation.data() + 4 * b;
        pile.world.bodies.position[b]    = Vec3<double>(fields.position.data() + 3 * b);
        pile.world.bodies.orientation[b] = Quat(q[0], q[1], q[2], q[3]);
    }
    return rest;
}

/// Time scales (s) of touching contacts.
struct LiveTimes
{
    double body = std::numeric_limits<double>::infinity(); ///< least sqrt(m / sum K) of bodies
    double pair = std::numeric_limits<double>::infinity(); ///< least sqrt(m* / K) of pairs
};

LiveTimes live_times(const Pile& pile)
{
    const std::vector<double>& mass = pile.world.bodies.mass;
    std::vector<double>        sums(mass.size(), 0.0);
    LiveTimes                  found;
    for (const world::ContactRecord& contact : pile.world.contacts)
    {
        const auto   a    = static_cast<std::size_t>(dem::first_of(contact.key));
        const auto   b    = static_cast<std::size_t>(dem::second_of(contact.key));
        const bool   wall = b >= mass.size();
        const double K    = contact.patch.stiffness;
        sums[a] += K;
        if (!wall) { sums[b] += K; }
        found.pair = std::min(found.pair, std::sqrt(1 / (K * (1 / mass[a] + (wall ? 0.0 : 1 / mass[b])))));
    }
    for (std::size_t b = 0; b < mass.size(); ++b)
    {
        if (sums[b] > 0) { found.body = std::min(found.body, std::sqrt(mass[b] / sums[b])); }
    }
    return found;
}

/// Whether the pile gains less than a thousandth of its contact and kinetic energy in 1,000 substeps of dt (s).
bool keeps_energy(const Cpu& cpu, const Pile& pile, double dt)
{
    constexpr int    substeps = 1000;
    constexpr double touch    = 1e-12; // s: contacts at their present positions
    Run              run(cpu, pile);
    run.advance(touch, 0);
    const double              start = run.energy();
    const solver::RigidCensus now   = run.rigid().census();
    for (int done = 0; done < substeps; done += block)
    {
        run.advance(dt, 0);
        if (!(run.energy() - start < 1e-3 * (now.contact + now.kinetic))) { return false; }
    }
    return true;
}

/// Largest stable substep, s, of a series that starts at half of `time` (s) and grows by 5 %: the last one before
/// energy is gained. Nothing dissipates: restitution 1, and friction that never slides.
double largest_stable(const Cpu& cpu, Pile pile, double time)
{
    for (scene::Contact& contact : pile.scene.contacts)
    {
        contact.friction         = 1e6;
        contact.rolling_friction = 0;
        contact.restitution      = 1;
    }
    double stable = 0;
    for (double dt = 0.5 * time; keeps_energy(cpu, pile, dt); dt *= 1.05) { stable = dt; }
    return stable;
}

/// Rayleigh wave time over a sphere, s (docs/theory.md#substeps).
double rayleigh_time(const scene::Material& stone)
{
    const double shear = stone.young / (2 * (1 + poisson));
    return std::numbers::pi * test::rock_radius * std::sqrt(stone.density / shear) / (0.1631 * poisson + 0.8766);
}

/// Duration, s, of a Hertz impact of two of the spheres at 1 m/s: 2.943275 d/v.
double hertz_impact_time(const scene::Material& stone)
{
    const double mass   = stone.density * 4.0 / 3 * std::numbers::pi * std::pow(test::rock_radius, 3) / 2;
    const double radius = test::rock_radius / 2, young = stone.young / (2 * (1 - poisson * poisson));
    return 2.943275 * std::pow(15 * mass / (16 * young * std::sqrt(radius)), 0.4);
}

void print(const char* kind, const Pile& pile, const Rest& rest, double stable)
{
    const scene::Material& stone = pile.scene.materials.front();
    const LiveTimes        live  = live_times(pile);
    std::printf("%s,%.0e,%.0e,%.1e,%.4e,%.4e,%.4e,%.4e,%.4e,%.4e\n", kind, stone.young,
                pile.scene.numerics.linear_overlap, rest.kinetic, live.body, live.pair, rest.contact, stable,
                rayleigh_time(stone), hertz_impact_time(stone));
    std::fflush(stdout);
}

} // namespace

int main()
{
    Counters              counters;
    const Cpu             cpu{&counters};
    const test::RockForms forms;
    std::printf("kind,young_Pa,linear_overlap,kinetic_mgR,live_body_s,live_pair_s,solver_s,stable_s,rayleigh_s,"
                "hertz_impact_s\n");
    for (const Kind& kind : {Kind{"exact spheres", "sphere", 1}, Kind{"spheres of nodes", "sphere", 0},
                             Kind{"irregular rocks", "bumpy", 1}, Kind{"cubes", "cube", 1}})
    {
        Pile start = poured(forms, kind);
        settle(cpu, start, 0.3, 1);
        for (const double knee : {1e-2, 1e-3, 1e-4})
        {
            Pile pile                          = start;
            pile.scene.numerics.linear_overlap = knee;
            for (const double young : {1e7, 1e8, 1e9, 1e10})
            {
                pile.scene.materials.front().young = young;
                const Rest rest                    = settle(cpu, pile, 0.002, 0.2);
                print(kind.name, pile, rest, largest_stable(cpu, pile, live_times(pile).body));
            }
        }
    }
    return 0;
}
