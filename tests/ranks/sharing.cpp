#include "physics/rock_scenes.hpp"
#include "side_by_side.hpp"

// Which bodies ranks share. Pages are 0.16 m wide and begin half a spacing from the origin: the border is at x = 0.34
// m.
namespace tread
{
namespace sharing_test
{

enum class SandMarks
{
    none,
    where_sand_is
};

template<class Exec>
class Sharing : public test::BackendTest<Exec>
{
protected:
    /// Rocks that nothing pulls, on a floor of two ranks' pages.
    struct Rocks
    {
        Rocks(const Exec& exec, const std::string& rocks, SandMarks marks)
            : scene(test::load_text(
                  test::rock_domain(size, 0, "x = \"open\", y = \"open\", bottom = \"fixed\", top = \"open\"", "") +
                  test::stone(1e7, 0.5, 0.5) + rocks + "\n[time]\ndt = 0.0002\n" + test::phase("fall", 0, 1)))
            , world(world::build_world(scene))
            , decomposition(test::world(), exec, test::decomposition_options())
            , rigid(exec, scene, world, solver::make_plan(scene, world, test::world().size()), owned(marks))
        {
            rigid.find_pairs(2e-4);
        }

        decomp::Decomposition<Exec>* owned(SandMarks marks)
        {
            const auto halves = [second = std::min(1, test::world().size() - 1)](const Vec3<double>& page)
            { return page[0] < 0.37 ? 0 : second; };
            const test::OwnedPages pages = test::pages_of(solver::page_lattice_of(world), size, halves);
            decomposition.owners.assign(pages.key, pages.rank);
            if (marks == SandMarks::where_sand_is)
            {
                decomposition.owners.enter_sand(solver::pages_of(world).with_sand);
            }
            return &decomposition;
        }

        const Vec3<double>          size{0.8, 0.2, 0.2};
        scene::Scene                scene;
        world::World                world;
        decomp::Decomposition<Exec> decomposition;
        solver::DemSolver<Exec>     rigid;
    };

    /// Whether this rank shares a body of these rocks.
    bool shares(const std::string& rocks, SandMarks marks = SandMarks::where_sand_is)
    {
        return Rocks(this->exec(), rocks, marks).rigid.shares();
    }

    /// Whether this rank is one of two that may share something.
    static bool is_one_of_two() { return test::world().size() > 1 && test::world().rank() < 2; }
};
TYPED_TEST_SUITE(Sharing, test::Backends, test::BackendNames);

const std::string form = R"(
[[shape]]
name      = "clast"
generate  = { kind = "rock", seed = 3, aspect = 0.7, sphericity = 0.9, nodes = 162 }
sdf_cells = 24
)";

std::string rock(const std::string& name, double x)
{
    return fmt::format(R"(
[[body]]
name = "{}"
shape = "clast"
material = "stone"
density = 2700.0
diameter = 0.04
position = [{}, 0.1, 0.05]
)",
                       name, x);
}

/// Two rocks, each in the middle of a rank's pages; then one of them at the border.
TYPED_TEST(Sharing, NothingFarFromTheBorder)
{
    EXPECT_FALSE(this->shares(form + rock("one", 0.2) + rock("other", 0.6)));
    EXPECT_EQ(this->shares(form + rock("one", 0.35) + rock("other", 0.6)), this->is_one_of_two());
}

/// A rock in one rank's pages, 0.12 m from those of another, which it cannot reach; and 0.29 m from them. Sand may come
/// six spacings, 0.24 m, out of pages that it has been in.
TYPED_TEST(Sharing, SandOfAnotherRankCountsWhereItHasBeen)
{
    const std::string sand = R"(
[grid]
spacing = 0.04
[[material]]
name               = "sand"
model              = "mohr-coulomb"
density            = 1600.0
young              = 1.0e6
poisson            = 0.3
friction_angle_deg = 32.0
dilation_angle_deg = 0.0
cohesion           = 0.0
[[contact]]
between  = ["stone", "sand"]
friction = 0.4
[[terrain]]
material = "sand"
region   = { box = [[0.4, 0.0, 0.0], [0.8, 0.2, 0.12]] }
)";
    EXPECT_EQ(this->shares(form + sand + rock("rock", 0.22)), this->is_one_of_two());
    EXPECT_FALSE(this->shares(form + sand + rock("rock", 0.22), SandMarks::none));
    EXPECT_FALSE(this->shares(form + sand + rock("rock", 0.05)));
}

/// A rock at rest, 0.14 m from the pages of another rank, whose rock may come to it before the next search while it is
/// fast: it goes 0.13 m in two steps. Slow again, it may not.
TYPED_TEST(Sharing, ABodyIsHeldWhileAFastOneMayComeToIt)
{
    typename TestFixture::Rocks rocks(this->exec(), form + rock("one", 0.2) + rock("other", 0.6),
                                      SandMarks::where_sand_is);
    const auto                  hold_when = [&](double speed)
    {
        const Vec3<double> velocity(0, 0, speed);
        copy_from_host(this->exec(), rocks.rigid.view().velocity + 1, &velocity, sizeof(velocity));
        rocks.rigid.forget_list();
        rocks.rigid.find_pairs(2e-4);
        return rocks.rigid.bodies().role.to_host().front();
    };
    const int  rank     = test::world().rank();
    const auto expected = [&](bool held) -> std::int32_t
    {
        if (rank == 0) { return dem::role_owner; }
        return rank == 1 && held ? dem::role_ghost : dem::role_none;
    };
    EXPECT_EQ(hold_when(0), expected(false));
    EXPECT_EQ(hold_when(300), expected(true));
    EXPECT_EQ(hold_when(290), expected(true));
    EXPECT_EQ(hold_when(0), expected(false));
    EXPECT_FALSE(rocks.rigid.shares());
}

} // namespace sharing_test
} // namespace tread
