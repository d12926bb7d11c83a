#include <filesystem>

#include "base/random.hpp"
#include "io/h5.hpp"
#include "joint_scenes.hpp"
#include "mpi_session.hpp"
#include "restart.hpp"
#include "thrown_roller.hpp"

// A run that is stopped and resumed from a checkpoint, compared with an uninterrupted one.
namespace
{

using namespace tread;

template<class Exec>
class Restart : public test::RestartTest<Exec>
{
};
TYPED_TEST_SUITE(Restart, test::Backends, test::BackendNames);

template<class Exec>
class FullSizeRestart : public Restart<Exec>
{
};
TYPED_TEST_SUITE(FullSizeRestart, test::Backends, test::BackendNames);

TYPED_TEST(Restart, OfSandGivesTheSameBits) { this->expect_same_bits(test::sand_text); }

/// Saved in the middle of ramps of velocity, torque and load, in a phase with a stop.
TYPED_TEST(Restart, OfABodyInAMotionGivesTheSameBits)
{
    std::string text = test::roller_text;
    text.replace(text.find("lock     ="), 45, "");
    text.replace(text.find("position = [0.2, 0.2, 0.33]"), 27, "position = [0.2, 0.2, \"on surface\"]\ngap = 0.004");
    text.replace(text.find("duration = 0.05"), 15, R"(duration = 0.05
[[phase]]
name     = "tow"
duration = 0.5
[[phase.motion]]
body          = "roller"
frame         = "body"
rotation_frame = "body"
x             = { velocity = 0.1, ramp = 0.4 }
y             = "held"
yaw           = "held"
roll          = "held"
axle          = { torque = 0.05, ramp = 0.3 }
axle_friction = 0.01
load          = { force = 80.0, ramp = 0.3 }
until         = { force_z = 1000.0 })");
    this->expect_same_bits(text);
    EXPECT_EQ(this->phase_saved_, 1U);
}

/// Saved in a phase with another gravity and another friction than the one before.
TYPED_TEST(Restart, InAPhaseWithItsOwnGravityAndContactsGivesTheSameBits)
{
    std::string text = test::roller_text;
    text.replace(text.find("duration = 0.05"), 15, R"(duration = 0.02
[[phase]]
name     = "tilt"
duration = 0.5
gravity  = [1.0, 0.0, -9.0]
contacts = [ { between = ["steel", "sand"], friction = 0.1 } ])");
    this->expect_same_bits(text);
    EXPECT_EQ(this->phase_saved_, 1U);
}

/// A scene and a roller that comes down into it at 1 m/s from `height`. Its pairs with the families `others` touch in
/// the first phase and in the second one if `before` and `after` say so.
std::string switched_text(std::string text, const std::vector<std::string>& others, const std::string& height,
                          double first, const char* before, const char* after)
{
    text += test::thrown_roller_text + "[time]\ndt = 1e-4\n";
    text.replace(text.find("young   = 1.0e9"), 15, "young   = 1.0e7"); // fewer substeps
    text.replace(text.find("0.2, 0.32]"), 10, "0.2, " + height + "]");
    std::string settings;
    for (const std::string& other : others)
    {
        text += fmt::format("[[contact]]\nbetween = [\"steel\", \"{}\"]\ntouch = {}\n", other, before);
        settings += fmt::format("{{ between = [\"steel\", \"{}\"], touch = {} }}, ", other, after);
    }
    return text.replace(text.find("duration = 0.05"), 15,
                        fmt::format("duration = {}\n[[phase]]\nname = \"switched\"\nduration = 0.5\ncontacts = [ {} ]",
                                    first, settings));
}

/// Saved between the last step of a phase and the first of the next, in which contacts let go.
TYPED_TEST(FullSizeRestart, WherePairsCeaseToTouchGivesTheSameBits)
{
    this->expect_same_bits(switched_text(test::sand_text + test::rocks_text, {"sand", "rock"}, "\"on surface\"",
                                         1e-4 * this->before, "true", "false"));
    EXPECT_EQ(this->phase_saved_, 1U);
    EXPECT_NEAR(this->time_saved_, 1e-4 * this->before, 1e-9) << "it is not the border";
}

/// Saved in the phase in which they have let go.
TYPED_TEST(FullSizeRestart, WherePairsHaveCeasedToTouchGivesTheSameBits)
{
    this->expect_same_bits(
        switched_text(test::sand_text, {"sand"}, "\"on surface\"", 1e-4 * (this->before - 20), "true", "false"));
    EXPECT_EQ(this->phase_saved_, 1U);
}

/// Saved between the last step of a phase and the first of the next, in which pairs begin to touch.
TYPED_TEST(FullSizeRestart, WherePairsBeginToTouchGivesTheSameBits)
{
    this->expect_same_bits(switched_text(test::sand_text, {"sand"}, "0.34", 1e-4 * this->before, "false", "true"));
    EXPECT_EQ(this->phase_saved_, 1U);
    EXPECT_NEAR(this->time_saved_, 1e-4 * this->before, 1e-9) << "it is not the border";
}

/// Saved during lowering, then released at half its weight, with a weight that grows.
TYPED_TEST(Restart, OfABodyThatIsLoweredGivesTheSameBits)
{
    std::string text = test::roller_text;
    text.replace(text.find("position = [0.2, 0.2, 0.33]"), 27, "position = [0.2, 0.2, \"on surface\"]\ngap = 0.004");
    text.replace(text.find("duration = 0.05"), 15,
                 "until = \"lowered\"\nmax_duration = 1.0\n"
                 "lower = { body = \"roller\", speed = 0.03, share = 0.5 }");
    text.replace(text.find("\"x\", \"y\", \"roll\", \"pitch\", \"yaw\""), 32, "\"y\"");
    this->expect_same_bits(text + R"(
[[phase]]
name     = "load"
duration = 1.0
weight   = { body = "roller", from = 0.5, to = 1.0, ramp = 0.5 }
)");
    EXPECT_EQ(this->phase_saved_, 0u);
    EXPECT_EQ(this->phase_at_end_, 1u);
}

TYPED_TEST(Restart, OfRocksGivesTheSameBits)
{
    this->expect_same_bits(test::rocks_alone + test::rocks_text + "placement = \"rain\"\n" + test::thrown_roller_text);
}

/// The factors of the rocks' inertia are saved.
TYPED_TEST(Restart, OfRocksWithScaledInertiaGivesTheSameBits)
{
    this->expect_same_bits(test::rocks_alone + test::rocks_text + "placement = \"rain\"\n" + test::thrown_roller_text +
                           "[time]\nmass_scaling = 9.0\n");
}

TYPED_TEST(Restart, OfSandRocksAndAWheelGivesTheSameBits)
{
    this->expect_same_bits(test::sand_text + test::rocks_text + test::thrown_roller_text);
}

/// Saved while the motor works against its largest torque; a joint reaches its stop and another is held by its spring.
TYPED_TEST(Restart, OfJointedBodiesGivesTheSameBits)
{
    this->expect_same_bits(test::swinging_under_gravity(1.0));
    EXPECT_EQ(this->phase_saved_, 1u);
}

/// Saved while a motion tows a body on whose weld another one swings.
TYPED_TEST(Restart, OfABodyWithAMotionAndAJointGivesTheSameBits)
{
    this->expect_same_bits(test::moved_text(1.0, "x = { velocity = 0.4, ramp = 0.8 }, z = \"held\", roll = \"held\", "
                                                 "yaw = \"held\""));
}

/// Moves all points and bodies of a saved state by up to `distance` (m) along each axis.
void perturb(const std::string& path, double distance, std::uint64_t seed)
{
    Random             random(seed);
    const io::h5::File file = io::h5::File::append(path);
    for (const char* name : {"points/position_0", "points/position_1", "points/position_2", "bodies/position"})
    {
        const io::h5::Handle dataset{io::h5::checked(H5Dopen2(file.id(), name, H5P_DEFAULT), path, name), H5Dclose};
        const io::h5::Handle space{H5Dget_space(dataset.id()), H5Sclose};
        std::vector<double>  values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
        H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        for (double& value : values) { value += random.uniform(-distance, distance); }
        H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
}

/// Largest distance, m, of a point or body between two runs.
template<class Exec>
double furthest(test::SavedRun<Exec>& run, test::SavedRun<Exec>& other)
{
    const auto               points = run.points(), others = other.points();
    std::vector<std::size_t> place(points.id.size());
    for (std::size_t i = 0; i < others.id.size(); ++i) { place.at(others.id[i]) = i; }
    double found = 0;
    for (std::size_t i = 0; i < 3 * points.id.size(); ++i)
    {
        const std::size_t there = 3 * place[points.id[i / 3]] + i % 3;
        found                   = std::max(found, std::abs(points.position[i] - others.position[there]));
    }
    const auto bodies = run.bodies().position, other_bodies = other.bodies().position;
    for (std::size_t i = 0; i < bodies.size(); ++i) { found = std::max(found, std::abs(bodies[i] - other_bodies[i])); }
    return found;
}

/// Lists are rebuilt, as on another number of ranks: only the order of sums differs. The number of substeps is given,
/// since an automatic one counts contacts that may begin, and lists of another age have others.
TYPED_TEST(Restart, WithListsMadeAnewAgreesAsFarAsChaosLetsIt)
{
    const std::string              text = test::sand_text + test::rocks_text + "[time]\nsubsteps = 8\n";
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("state.h5"), moved = directory.path("moved.h5");
    constexpr int                  steps = 100;

    test::SavedRun<TypeParam> whole(this->exec(), text);
    whole.step(100);
    whole.save(path);
    whole.step(steps);
    double spread = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
    {
        std::filesystem::copy_file(path, moved, std::filesystem::copy_options::overwrite_existing);
        perturb(moved, 1e-9, seed);
        test::SavedRun<TypeParam> repeat(this->exec(), text);
        repeat.load(moved, solver::Fidelity::exact);
        repeat.step(steps);
        spread = std::max(spread, furthest(whole, repeat));
    }
    test::SavedRun<TypeParam> resumed(this->exec(), text);
    resumed.load(path, solver::Fidelity::physical);
    resumed.step(steps);
    const double off = furthest(whole, resumed);
    test::report("furthest that a point or body is off (m)", off, 0, spread,
                 "what five repeats come to of which everything was moved by up to 1e-9 m when the state was saved");
    EXPECT_LE(off, spread);
}

} // namespace
