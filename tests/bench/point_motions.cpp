#include <cstdio>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "physics/rock_scenes.hpp"
#include "physics/sphere_on_bed.hpp"

// Prints docs/studies/point_motions.csv: a sphere or wheel on a bed with the three motions of points in the substeps;
// an argument selects the cases whose name begins with it.
namespace
{

using namespace tread;

struct Case
{
    std::string       name;
    test::SphereOnBed bed;
};

constexpr const char* sand = "model = \"mohr-coulomb\"\nfriction_angle_deg = 35.0";

test::SphereOnBed held(int points_per_cell)
{
    test::SphereOnBed bed;
    bed.sideways        = 0.15;
    bed.settling        = 0.1;
    bed.free            = 0.08; // a creeping sphere must not reach the walls
    bed.points_per_cell = points_per_cell;
    return bed;
}

/// Long enough for the sphere to slip in the second half: friction yields after about 1 mm.
test::SphereOnBed drawn(double speed, const std::string& law, int points_per_cell)
{
    test::SphereOnBed bed;
    bed.law             = law;
    bed.speed           = speed;
    bed.points_per_cell = points_per_cell;
    bed.free            = speed < 0.05 ? 0.5 : 0.1;
    if (law == sand)
    {
        bed.settling = 0.25;
        bed.free     = speed < 0.05 ? 0.6 : 0.15;
        bed.width    = 0.28;
    }
    return bed;
}

/// A seventeenth of the automatic step: if points lose a little friction in each step, more steps lose more.
test::SphereOnBed drawn_in_short_steps()
{
    test::SphereOnBed bed = drawn(0.1, sand, 1);
    bed.dt                = "1.0e-5";
    bed.settling          = 0.12;
    bed.free              = 0.08;
    return bed;
}

/// A wheel with grousers at a slip of 0.3.
test::SphereOnBed rolling()
{
    test::SphereOnBed bed;
    bed.law = sand;
    bed.form =
        "kind = \"wheel\", radius = 0.1, width = 0.12, wall_thickness = 0.03, grousers = 12, grouser_height = 0.01, "
        "grouser_width = 0.01";
    bed.speed    = 0.1;
    bed.spin     = bed.speed / (0.7 * bed.radius);
    bed.settling = 0.25;
    bed.free     = 0.5;
    bed.width    = 0.4;
    return bed;
}

/// One layer of points between a sphere and a fixed slab, which both touch it.
test::SphereOnBed between_bodies(const test::MeshFile& slab, double half_height)
{
    test::SphereOnBed bed = held(1);
    bed.depth             = bed.spacing;
    bed.bottom            = 6 * bed.spacing;
    const double level    = bed.bottom - 0.13 * bed.spacing - half_height; // clear of the points' radius
    bed.beneath           = test::file_shape("slab", slab, 0.02, 64) + fmt::format(R"(
[[body]]
name     = "slab"
shape    = "slab"
material = "steel"
mass     = 10.0
position = [{}, {}, {}]
lock     = ["x", "y", "z", "roll", "pitch", "yaw"]
)",
                                                                                   bed.width / 2, bed.width / 2, level);
    return bed;
}

/// 64 points per cell: k dt^2/m_p is large at steps that are still stable for the grid.
test::SphereOnBed rattling(const std::string& dt)
{
    test::SphereOnBed bed;
    bed.points_per_cell = 64;
    bed.spacing         = 0.02;
    bed.width           = 0.24;
    bed.depth           = 0.06;
    bed.settling        = 0.08;
    bed.free            = 0.04;
    bed.friction        = 0;
    bed.dt              = dt;
    return bed;
}

const Vec3<double> half_slab{0.11, 0.11, 0.02}; // m

std::vector<Case> cases(const test::MeshFile& slab)
{
    std::vector<Case> all{{"held at 0.15 W, elastic", held(1)},
                          {"held at 0.15 W, elastic", held(8)},
                          {"drawn at 0.1 m/s, elastic", drawn(0.1, test::SphereOnBed{}.law, 1)},
                          {"drawn at 0.1 m/s, elastic", drawn(0.1, test::SphereOnBed{}.law, 8)},
                          {"drawn at 0.01 m/s, elastic", drawn(0.01, test::SphereOnBed{}.law, 1)},
                          {"drawn at 0.1 m/s, sand", drawn(0.1, sand, 1)},
                          {"drawn at 0.01 m/s, sand", drawn(0.01, sand, 1)},
                          {"drawn at 0.1 m/s, sand, 10 us", drawn_in_short_steps()},
                          {"rolling at 0.1 m/s, sand", rolling()},
                          {"held at 0.15 W between two bodies, elastic", between_bodies(slab, half_slab[2])}};
    for (const char* dt : {"2.0e-4", "4.0e-4", "5.6e-4", "8.0e-4"}) { all.push_back({"at rest", rattling(dt)}); }
    return all;
}

void print(const Cpu& cpu, const Case& one, const std::string& motion, int substeps)
{
    test::SphereOnBed bed = one.bed;
    bed.motion            = motion;
    bed.substeps          = substeps;
    std::printf("\"%s\",%d,%s,%d,", one.name.c_str(), bed.points_per_cell, motion.c_str(), substeps);
    try
    {
        const test::Watched ball = test::watch_sphere(cpu, bed);
        std::printf("%.3g,%.3g,%.4g,%.4g,%.2g,%.4g,%.2g,%.4g\n", ball.dt, ball.spring, ball.creep, ball.pull,
                    ball.pull_jitter, ball.lift, ball.jitter, ball.height);
    }
    catch (const NumericalError&)
    {
        std::printf(",,,,,,,\n"); // stopped, which is a result too
    }
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
    const std::string wanted = argc > 1 ? argv[1] : "";
    Counters          counters;
    const Cpu         cpu{&counters};
    std::printf("case,points_per_cell,motion,substeps,dt_s,spring,creep_m_s,pull,pull_jitter,lift,jitter,height_m\n");
    const test::MeshFile slab(test::box_mesh(half_slab));
    for (const Case& one : cases(slab))
    {
        if (!one.name.starts_with(wanted)) { continue; }
        print(cpu, one, "supported", 1); // all motions are the same with one substep
        for (const char* motion : {"supported", "ballistic", "frozen"}) { print(cpu, one, motion, 100); }
    }
    return 0;
}
