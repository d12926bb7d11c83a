#include <set>
#include <string>

#include <gtest/gtest.h>

#include "scene_text.hpp"
#include "solver/plan.hpp"
#include "solver/simulation.hpp"

// "Leave out what a given scene does not need": what a scene allocates and launches is counted by name.
namespace
{

using namespace tread;
using namespace tread::solver;
using test::load_text;

struct Used
{
    std::set<std::string> arrays; ///< that ever held memory
    std::set<std::string> kernels;
};

Used run_steps(const scene::Scene& scene)
{
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
    Used used;
    for (const auto& [name, bytes] : counters.bytes()) { used.arrays.insert(name); }
    for (const auto& [name, launches] : counters.launches()) { used.kernels.insert(name); }
    return used;
}

std::string without(std::string text, const std::string& table)
{
    const auto begin = text.find(table);
    const auto end   = text.find("\n[", begin + 1);
    return text.erase(begin, end - begin + 1);
}

bool any_with(const std::set<std::string>& names, const std::vector<std::string>& words)
{
    for (const std::string& name : names)
    {
        for (const std::string& word : words)
        {
            if (name.find(word) != std::string::npos)
            {
                ADD_FAILURE() << "not needed: " << name;
                return true;
            }
        }
    }
    return false;
}

TEST(LeftOut, SandAloneKnowsNoBodies)
{
    const Used used = run_steps(load_text(test::sand_text));
    EXPECT_FALSE(
        any_with(used.arrays, {"body", "bodies", "pair", "contact", "candidate", "template", "private", "support"}));
    EXPECT_FALSE(any_with(used.kernels, {"body", "bodies", "pair", "contact", "candidate", "integrate"}));
    EXPECT_TRUE(used.kernels.count("scatter"));
}

TEST(LeftOut, OneRankSharesNothing)
{
    const Used used = run_steps(load_text(test::sand_text));
    EXPECT_FALSE(
        any_with(used.arrays, {"shared pages", "shared page", "halo", "leaving", "owner", "owned", "message"}));
    EXPECT_FALSE(any_with(used.kernels, {"shared", "leaving", "pack rows", "booked elsewhere"}));
}

TEST(LeftOut, WithoutADistanceNothingSleeps)
{
    const std::vector<std::string> arrays{"sleep", "held", "wake", "largest speeds"}, kernels{"held", "hold", "keep"};
    const Used                     used = run_steps(load_text(test::sand_text));
    EXPECT_FALSE(any_with(used.arrays, arrays));
    EXPECT_FALSE(any_with(used.kernels, kernels));
    const Used sleeping = run_steps(load_text(test::sand_text + "\n[sleep]\ndistance = 0.2\n"));
    EXPECT_TRUE(sleeping.arrays.count("largest speeds of pages"));
    EXPECT_TRUE(sleeping.kernels.count("keep largest speeds"));
}

TEST(LeftOut, PlainFlipHasNoAffineVelocities)
{
    EXPECT_TRUE(run_steps(load_text(test::sand_text)).arrays.count("point affine velocity"));
    EXPECT_FALSE(
        any_with(run_steps(load_text(test::sand_text + "\n[numerics]\ntransfer = \"flip\"\n")).arrays, {"affine"}));
}

TEST(LeftOut, RocksAloneKnowNoGrid)
{
    std::string text = without(test::sand_text, "[[terrain]]") + test::rocks_text + "placement = \"grid\"\n";
    const Used  used = run_steps(load_text(text));
    EXPECT_FALSE(any_with(used.arrays, {"point", "page", "tile", "grid", "cell first", "order", "candidate"}));
    EXPECT_FALSE(any_with(used.kernels, {"scatter", "gather points", "update grid", "point", "page", "candidate"}));
    EXPECT_TRUE(used.kernels.count("move bodies") + used.kernels.count("substeps of bodies") > 0);
    EXPECT_FALSE(any_with(used.arrays, {"triangles", "boxes", "normals", "ray"}));
}

/// One list holds the pages around wheels and rocks alike. A body that no sand is near has a look at its own few pages,
/// and that is all.
TEST(LeftOut, BodiesFarFromSandHaveNoContactsWithIt)
{
    std::string high = test::roller_text;
    high.replace(high.find("[0.2, 0.2, 0.33]"), 16, "[0.2, 0.2, 0.45]");
    const Used used = run_steps(load_text(high));
    EXPECT_FALSE(any_with(used.arrays, {"private", "contact response", "contact wrench", "contact tangential",
                                        "contact summary sums", "history"}));
    EXPECT_FALSE(any_with(used.kernels, {"write candidates", "copy contact points", "point-body forces", "recall",
                                         "move contact points", "give back", "summarise"}));
    EXPECT_TRUE(used.kernels.count("count contact pages"));
}

TEST(LeftOut, AWheelOnSandKnowsNoRocks)
{
    std::string low = test::roller_text;
    low.replace(low.find("[0.2, 0.2, 0.33]"), 16, "[0.2, 0.2, 0.305]");
    const Used used = run_steps(load_text(low));
    EXPECT_TRUE(used.kernels.count("point-body forces"));
    EXPECT_FALSE(any_with(used.arrays, {"ray", "rolling", "contact slots"}));
    EXPECT_FALSE(any_with(used.kernels, {"sampled", "count contact slots", "resistance to rolling"}));
}

TEST(LeftOut, RocksOnSandKnowNoWheel)
{
    const Used used = run_steps(load_text(test::sand_text + test::rocks_text + "placement = \"replace\"\n"));
    EXPECT_TRUE(used.kernels.count("point-body forces"));
    EXPECT_FALSE(any_with(used.arrays,
                          {"patch places", "patches of", "several", "patch keys", "patch records", "rays", "rolling"}));
    EXPECT_FALSE(any_with(used.kernels, {"group pair nodes", "write patches", "several patches", "deal pair nodes"}));
}

TEST(LeftOut, TrianglesAreThereForRaysAlone)
{
    const std::string text = without(test::sand_text, "[[terrain]]") + test::rocks_text + "placement = \"grid\"\n";
    const Used        used = run_steps(load_text(text + "[numerics]\nnarrow_phase = \"rays\"\n"));
    for (const char* name :
         {"template boxes", "template triangles", "template node normals", "template ray lengths", "template rays"})
    {
        EXPECT_TRUE(used.arrays.count(name)) << name;
    }
}

TEST(LeftOut, ElasticSandHasNoPlasticState)
{
    std::string elastic = test::sand_text;
    elastic.replace(elastic.find("mohr-coulomb"), 12, "elastic");
    elastic.erase(elastic.find("friction_angle_deg"), 25);
    const Used used = run_steps(load_text(elastic));
    EXPECT_FALSE(any_with(used.arrays, {"plastic", "volume gap"}));
}

TEST(Plan, SaysWhyAStageIsLeftOut)
{
    const scene::Scene scene = load_text(test::sand_text);
    const World        world = build_world(scene);
    for (const Stage& stage : stages(scene, make_plan(scene, world), 1))
    {
        EXPECT_FALSE(stage.why.empty()) << stage.name;
        EXPECT_EQ(stage.on, stage.name == stage::order || stage.name == stage::scatter || stage.name == stage::grid ||
                                stage.name == stage::gather || stage.name == stage::plasticity ||
                                stage.name == stage::measure || stage.name == stage::output)
            << stage.name;
    }
}

} // namespace
