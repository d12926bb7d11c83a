#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "solver/plan.hpp"
#include "solver/simulation.hpp"

// "Leave out what a given scene does not need", told exactly: what each part of a scene allocates and launches is
// written down here, and what a scene uses is what its parts have, no less and no more. On one rank there is no MPI to
// call: this program never starts it, and any call would end it.
namespace
{

using namespace tread;
using namespace tread::solver;
using Names = std::set<std::string>;

struct Part
{
    Names arrays;
    Names kernels;
};

/// Terrain of an elastic material, with FLIP.
const Part sand = {{"cell first point",
                    "grid motion",
                    "grid sums",
                    "last step with moves",
                    "materials",
                    "neighbours of point pages",
                    "neighbours of wall pages",
                    "node page keys",
                    "node pages of point pages",
                    "order",
                    "order keys",
                    "order neighbour keys",
                    "order neighbour order",
                    "page moves",
                    "point census",
                    "point id",
                    "point list",
                    "point list cells",
                    "point mass",
                    "point material",
                    "point moves",
                    "point page first point",
                    "point page keys",
                    "point pages of node pages",
                    "point peaks",
                    "point position",
                    "point start",
                    "point stress",
                    "point sums",
                    "point velocity",
                    "point volume",
                    "point volume ratio",
                    "sand sums told",
                    "sand totals",
                    "sort scratch",
                    "sort scratch keys",
                    "sort scratch values",
                    "tiles",
                    "wall nodes",
                    "wall pages",
                    "wall pages of node pages"},
                   {"census",
                    "find neighbours",
                    "find node pages",
                    "find point pages",
                    "find wall pages",
                    "first points",
                    "gather",
                    "gather points",
                    "largest of rows",
                    "list points",
                    "mark pages",
                    "mark wall pages",
                    "neighbour keys",
                    "point keys",
                    "scan",
                    "scatter",
                    "sort",
                    "sum rows",
                    "surrounding keys",
                    "update grid",
                    "update walls",
                    "write cells",
                    "write pages",
                    "write wall pages"}};

/// What AFLIP and APIC add.
const Part affine_velocities = {{"point affine velocity"}, {}};

/// A granular material's.
const Part plastic_state = {{"point plastic rate", "point plastic shear", "point volume gap"}, {}};

/// Bodies that may meet a wall or each other.
const Part bodies = {{"bodies by cell",
                      "bodies in contact",
                      "body activity",
                      "body angular velocity",
                      "body bounding radii",
                      "body cells",
                      "body damped",
                      "body expected stiffness",
                      "body force",
                      "body inertia",
                      "body locked freedoms",
                      "body mass",
                      "body material",
                      "body node area",
                      "body orientation",
                      "body orientation at search",
                      "body overlap told",
                      "body position",
                      "body position at search",
                      "body reach",
                      "body scale",
                      "body shape",
                      "body stiffness",
                      "body sums",
                      "body sums told",
                      "body torque",
                      "body totals",
                      "body travel",
                      "body travel shares",
                      "body travel told",
                      "body velocity",
                      "large body marks",
                      "nodes inside",
                      "nodes of pairs",
                      "pair measures",
                      "pair properties",
                      "pairs by second body",
                      "pairs found",
                      "pairs of first body",
                      "pairs of second body",
                      "template cluster radii",
                      "template clusters",
                      "template node areas",
                      "template nodes",
                      "template sdf",
                      "templates",
                      "walls"},
                     {"body cells",
                      "body motion",
                      "body reach",
                      "body sizes",
                      "body speeds",
                      "body sums",
                      "contact frequencies",
                      "count pairs",
                      "expected contacts",
                      "keep pairs",
                      "largest of rows",
                      "mark pairs",
                      "measure activity",
                      "measure strays",
                      "move bodies",
                      "pairs of bodies",
                      "scan",
                      "sort",
                      "stage bodies",
                      "sum rows",
                      "write pairs"}};

/// Of [[body]] tables: the recorder's.
const Part named_bodies = {{"contact impulses"}, {}};

/// Wheels: they may touch another body in several places.
const Part concave_bodies = {{"patches of pairs"}, {"group pair nodes", "pairs of several patches"}};

/// Bodies that are near each other or a wall.
const Part pairs = {{"last pair keys", "pair keys"}, {"count pair nodes"}};

/// All substeps of these go by without sand.
const Part pairs_without_sand = {{"pair second bodies"}, {}};

/// Pairs that come from the large bodies are sorted among the others.
const Part pairs_of_a_large_body = {{"sort scratch"}, {}};

/// Sand near bodies.
const Part contact_with_sand = {
    {"candidate body",
     "candidate point",
     "candidate touched point",
     "candidates by point",
     "contact cells found",
     "contact dissipated",
     "contact page",
     "contact page body",
     "contact page boxes",
     "contact pages found",
     "contact part first item",
     "contact part run",
     "contact parts as one run",
     "contact response",
     "contact run first part",
     "contact run marks",
     "contact run of body",
     "contact sort keys",
     "contact sorted points",
     "contact summary",
     "contact summary sums",
     "contact summary told",
     "contact tangential",
     "contact wrench sums",
     "point contact force",
     "point grid velocity",
     "point support",
     "private point id",
     "private point impulse",
     "private point mass",
     "private point material",
     "private point position",
     "private point radius",
     "private point support",
     "private point velocity",
     "touched bodies",
     "touched body first candidate",
     "touched point first candidate",
     "touched points"},
    {"all contact parts",   "bodies in sand",   "bodies without sand", "candidate sort keys", "candidate sorted points",
     "copy contact points", "count candidates", "count contact pages", "count parts",         "find contact pages",
     "give back impulses",  "mark runs",        "move contact points", "point-body forces",   "recall contacts",
     "summarise contacts",  "touched points",   "write candidates",    "write contact pages", "write parts",
     "write runs"}};

Part operator+(Part a, const Part& b)
{
    a.arrays.insert(b.arrays.begin(), b.arrays.end());
    a.kernels.insert(b.kernels.begin(), b.kernels.end());
    return a;
}

/// Of five steps from the start.
Part used_by(const std::string& text)
{
    const scene::Scene       scene = test::load_text(text);
    const World              world = build_world(scene);
    Counters                 counters;
    Simulation<Cpu, float>   simulation(Cpu{&counters}, scene, world, make_plan(scene, world));
    StageClock               clock;
    std::vector<BodyCommand> commands(scene.bodies.size());
    TimeStep                 step;
    for (int i = 0; i < 5; ++i)
    {
        step = choose_step(scene.time, simulation.limits(), simulation.pace(), step.dt);
        simulation.command(commands, 0);
        simulation.step(step, 0, clock);
    }
    Part used;
    for (const auto& [name, bytes] : counters.bytes()) { used.arrays.insert(name); }
    for (const auto& [name, launches] : counters.launches()) { used.kernels.insert(name); }
    return used;
}

std::string low_wheel()
{
    std::string text = test::roller_text;
    text.replace(text.find("[0.2, 0.2, 0.33]"), 16, "[0.2, 0.2, 0.305]");
    return text.replace(text.find("sdf_cells = 48"), 14, "sdf_cells = 20");
}

std::string without_terrain(std::string text)
{
    const auto begin = text.find("[[terrain]]");
    return text.erase(begin, text.find("\n[", begin + 1) - begin + 1);
}

std::string elastic_flip()
{
    std::string text = test::sand_text + "\n[numerics]\ntransfer = \"flip\"\n";
    text.replace(text.find("mohr-coulomb"), 12, "elastic");
    return text.erase(text.find("friction_angle_deg"), 25);
}

void expect_equal(const Names& used, const Names& written_down, const char* what)
{
    for (const std::string& name : used) { EXPECT_TRUE(written_down.count(name)) << what << " not needed: " << name; }
    for (const std::string& name : written_down) { EXPECT_TRUE(used.count(name)) << what << " not used: " << name; }
}

void expect_uses(const std::string& text, const Part& part)
{
    const Part used = used_by(text);
    expect_equal(used.arrays, part.arrays, "array");
    expect_equal(used.kernels, part.kernels, "kernel");
}

const Part        soil   = sand + affine_velocities + plastic_state;
const Part        wheel  = bodies + named_bodies + concave_bodies;
const std::string above  = test::rocks_text + "placement = \"grid\"\n",
                  within = test::rocks_text + "placement = \"replace\"\n";

TEST(LeftOut, ElasticSandWithFlip) { expect_uses(elastic_flip(), sand); }

TEST(LeftOut, SandAlone) { expect_uses(test::sand_text, soil); }

/// Nothing sleeps without a distance; with one, this is what looks and holds.
TEST(LeftOut, SandThatMaySleep)
{
    const Part sleep = {{"largest speeds of pages", "marks of held pages"},
                        {"keep largest speeds", "mark held pages", "write held pages"}};
    expect_uses(test::sand_text + "\n[sleep]\ndistance = 0.2\n", soil + sleep);
}

TEST(LeftOut, RocksAlone)
{
    expect_uses(without_terrain(test::sand_text) + above, bodies + pairs + pairs_without_sand);
}

TEST(LeftOut, AWheelOnRocks)
{
    expect_uses(without_terrain(low_wheel()) + above, wheel + pairs + pairs_without_sand + pairs_of_a_large_body);
}

TEST(LeftOut, AWheelOnSand) { expect_uses(low_wheel(), soil + wheel + contact_with_sand); }

TEST(LeftOut, RocksInSand) { expect_uses(test::sand_text + within, soil + bodies + pairs + contact_with_sand); }

TEST(LeftOut, AWheelOnSandWithRocks) { expect_uses(low_wheel() + within, soil + wheel + pairs + contact_with_sand); }

/// One list holds the pages around wheels and rocks alike. A body that no sand is near has a look at its own few pages,
/// and that is all.
TEST(LeftOut, BodiesFarFromSandHaveNoContactsWithIt)
{
    std::string high = low_wheel();
    high.replace(high.find("[0.2, 0.2, 0.305]"), 17, "[0.2, 0.2, 0.45]");
    const Part used = used_by(high);
    for (const char* name : {"private point position", "contact response", "contact wrench sums", "contact tangential"})
    {
        EXPECT_FALSE(used.arrays.count(name)) << name;
    }
    for (const char* name : {"write candidates", "copy contact points", "point-body forces", "recall contacts",
                             "move contact points", "give back impulses", "summarise contacts"})
    {
        EXPECT_FALSE(used.kernels.count(name)) << name;
    }
    EXPECT_TRUE(used.kernels.count("count contact pages"));
}

TEST(LeftOut, TrianglesAreThereForRaysAlone)
{
    const Part used = used_by(without_terrain(test::sand_text) + above + "[numerics]\nnarrow_phase = \"rays\"\n");
    for (const char* name :
         {"template boxes", "template triangles", "template node normals", "template ray lengths", "template rays"})
    {
        EXPECT_TRUE(used.arrays.count(name)) << name;
    }
}

} // namespace
