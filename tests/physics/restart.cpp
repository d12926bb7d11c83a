#include <cstring>
#include <filesystem>
#include <memory>

#include "base/random.hpp"
#include "harness.hpp"
#include "io/h5.hpp"
#include "joint_scenes.hpp"
#include "mpi_session.hpp"
#include "run/time_loop.hpp"
#include "solver/state_file.hpp"
#include "temporary_directory.hpp"
#include "thrown_roller.hpp"

// A run that is stopped and resumed from a checkpoint, compared with an uninterrupted one.
namespace
{

using namespace tread;

const std::string rocks_alone = R"(
[domain]
size    = [0.4, 0.4, 0.6]
gravity = [0.0, 0.0, -9.81]
[[contact]]
between          = ["rock", "rock"]
rolling_friction = 0.05
[[phase]]
name     = "rest"
duration = 0.5
)";

/// A scene run step by step, which can be saved and loaded.
template<class Exec>
class Run
{
public:
    Run(const Exec& exec, const std::string& text)
        : scene_(test::load_text(text))
        , world_(world::build_world(scene_))
        , simulation_(exec, scene_, world_, solver::make_plan(scene_, world_))
        , loop_(scene_, world_, simulation_)
    {
    }

    /// Runs at least `steps` steps, until the state may be saved. The last phase does not end.
    void step(int steps)
    {
        for (int i = 0; i < steps || !simulation_.measured(); ++i)
        {
            tread::run::take_step(loop_, {});
            if (loop_.phase.index + 1 < scene_.phases.size()) { tread::run::end_phases(loop_, {}); }
        }
    }

    std::size_t phase() const { return loop_.phase.index; }
    double      time() const { return loop_.progress.time; }

    void save(const std::string& path)
    {
        io::CheckpointWriter writer(self_, path);
        solver::StateFile    file(self_, writer, solver::Fidelity::exact);
        transfer(file);
        writer.finish();
    }

    void load(const std::string& path, solver::Fidelity fidelity)
    {
        const io::CheckpointReader reader(path);
        solver::StateFile          file(self_, reader, fidelity);
        transfer(file);
    }

    /// All data of snapshots, ledger and the next step, as bytes.
    std::vector<std::byte> state()
    {
        std::vector<std::byte> bytes;
        const auto             add = [&](const auto& values)
        {
            const auto* data = reinterpret_cast<const std::byte*>(values.data());
            bytes.insert(bytes.end(), data, data + values.size() * sizeof(values[0]));
        };
        const io::PointFields points = simulation_.point_fields();
        add(points.position);
        add(points.velocity);
        add(points.stress);
        add(points.plastic_shear);
        add(points.id);
        const io::BodyFields bodies = simulation_.body_fields();
        add(bodies.position);
        add(bodies.orientation);
        add(bodies.velocity);
        add(bodies.angular_velocity);
        const solver::EnergyRow energy = simulation_.ledger().energy(simulation_.census());
        add(std::vector<double>{energy.total, energy.friction, energy.transfer, energy.coupling, energy.contact,
                                loop_.progress.time, loop_.progress.chosen.dt, loop_.phase.start});
        return bytes;
    }

    /// Number of sleeping points.
    std::int64_t asleep() { return simulation_.sand().count() - simulation_.sand().view().count; }

    /// Number of sleeping rocks.
    std::int64_t rocks_asleep() const { return simulation_.rocks_asleep(); }

    io::PointFields points() const { return simulation_.point_fields(); }
    io::BodyFields  bodies() { return simulation_.body_fields(); }

private:
    void transfer(solver::StateFile& file)
    {
        simulation_.transfer(file);
        tread::run::transfer(file, scene_, loop_.phase, loop_.watch);
        tread::run::transfer(file, scene_, loop_.motions);
        file.numbers("run", loop_.progress.time, loop_.progress.chosen.dt);
        file.text("limit", loop_.progress.chosen.limit);
    }

    Communicator                       self_{MPI_COMM_SELF};
    scene::Scene                       scene_;
    world::World                       world_;
    solver::Simulation<Exec, double>   simulation_;
    tread::run::TimeLoop<Exec, double> loop_;
};

/// Number of rows of a data set of a state; 0 if there is none.
std::int64_t rows_of(const std::string& path, const std::string& name)
{
    const io::CheckpointReader reader(path);
    return reader.holds(name) ? reader.first_rows(name).back() : 0;
}

/// Numbers of points that slept in a run.
struct Sleepers
{
    std::int64_t saved;
    std::int64_t at_end;
};

template<class Exec>
class Restart : public test::BackendTest<Exec>
{
protected:
    static constexpr int before = 150, after = 150; ///< steps; lists of points, pairs and candidates change in both

    /// Returns the numbers of points that slept.
    Sleepers expect_same_bits(const std::string& text)
    {
        const test::TemporaryDirectory directory;
        const std::string              path = directory.path("state.h5");

        Run<Exec> whole(this->exec(), text);
        whole.step(before);
        whole.step(after);

        Run<Exec> stopped(this->exec(), text);
        stopped.step(before);
        stopped.save(path);
        phase_saved_              = stopped.phase();
        time_saved_               = stopped.time();
        const std::int64_t asleep = stopped.asleep();
        rocks_saved_              = stopped.rocks_asleep();
        contacts_saved_           = rows_of(path, "contact/asleep_key");
        Run<Exec> resumed(this->exec(), text);
        resumed.load(path, solver::Fidelity::exact);
        stopped.step(after);
        resumed.step(after);
        const auto expected = whole.state();
        EXPECT_EQ(stopped.state(), expected) << "to save changed what came after it";
        EXPECT_EQ(resumed.state(), expected) << "what went on from the file differs";
        phase_at_end_ = resumed.phase();
        rocks_at_end_ = resumed.rocks_asleep();
        return {asleep, resumed.asleep()};
    }

    std::size_t phase_saved_ = 0, phase_at_end_ = 0;
    double      time_saved_ = 0; ///< s

    std::int64_t rocks_saved_ = 0, rocks_at_end_ = 0; ///< asleep
    std::int64_t contacts_saved_ = 0;                 ///< of sand and rocks that sleep
};
TYPED_TEST_SUITE(Restart, test::Backends, test::BackendNames);

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
TYPED_TEST(Restart, WherePairsCeaseToTouchGivesTheSameBits)
{
    this->expect_same_bits(switched_text(test::sand_text + test::rocks_text, {"sand", "rock"}, "\"on surface\"",
                                         1e-4 * this->before, "true", "false"));
    EXPECT_EQ(this->phase_saved_, 1U);
    EXPECT_NEAR(this->time_saved_, 1e-4 * this->before, 1e-9) << "it is not the border";
}

/// Saved in the phase in which they have let go.
TYPED_TEST(Restart, WherePairsHaveCeasedToTouchGivesTheSameBits)
{
    this->expect_same_bits(
        switched_text(test::sand_text, {"sand"}, "\"on surface\"", 1e-4 * (this->before - 20), "true", "false"));
    EXPECT_EQ(this->phase_saved_, 1U);
}

/// Saved between the last step of a phase and the first of the next, in which pairs begin to touch.
TYPED_TEST(Restart, WherePairsBeginToTouchGivesTheSameBits)
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
    this->expect_same_bits(rocks_alone + test::rocks_text + "placement = \"rain\"\n" + test::thrown_roller_text);
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

/// Far from the roller: sleeping sand is saved asleep, and other sand falls asleep or wakes afterwards.
TYPED_TEST(Restart, OfSleepingSandGivesTheSameBits)
{
    std::string text = test::sand_text + test::thrown_roller_text +
                       "[sleep]\ndistance = 0.05\nspeed = 0.01\nrest = 2e-3\nload = 0.5\n";
    for (const std::string box : {"[0.4, 0.4, 0.6]", "[0.4, 0.4, 0.2]"}) { text.replace(text.find(box), 4, "[1.6"); }
    const Sleepers asleep = this->expect_same_bits(text);
    EXPECT_GT(asleep.saved, 0);
    EXPECT_NE(asleep.at_end, asleep.saved);
}

/// Sleeping rocks are saved asleep with their contacts; others fall asleep or wake afterwards.
TYPED_TEST(Restart, OfSleepingRocksGivesTheSameBits)
{
    this->expect_same_bits(rocks_alone + test::rocks_text + "placement = \"grid\"\n" + test::thrown_roller_text +
                           "[time]\ndt = 3e-3\n[sleep]\nrock_speed = 0.15\nrock_rest = 0.02\n");
    std::cout << this->rocks_saved_ << " rocks asleep when saved, " << this->rocks_at_end_ << " at the end\n";
    EXPECT_GT(this->rocks_saved_, 0);
    EXPECT_NE(this->rocks_at_end_, this->rocks_saved_);
}

/// Sand and rocks that sleep together are saved with what the sand presses the rocks with; the roller wakes both.
TYPED_TEST(Restart, OfSleepingSandAndRocksGivesTheSameBits)
{
    for (const std::string diameter : {"0.06", "0.025"}) // smaller rocks take samples of points
    {
        std::string rocks = test::rocks_text + "placement = \"replace\"\n";
        rocks.replace(rocks.find("= 0.06"), 6, "= " + diameter);
        std::string text = test::sand_text + rocks + test::thrown_roller_text +
                           "[sleep]\ndistance = 0.05\nspeed = 0.05\nrest = 2e-3\nload = 0.5\nrock_speed = 0.05\n"
                           "rock_rest = 2e-3\nrock_load = 0.5\n";
        for (const std::string box : {"[0.4, 0.4, 0.6]", "[0.4, 0.4, 0.2]"})
        {
            for (auto at = text.find(box); at != std::string::npos; at = text.find(box))
            {
                text.replace(at, 4, "[1.6");
            }
        }
        const Sleepers asleep = this->expect_same_bits(text);
        std::cout << "rocks of " << diameter << " m: " << asleep.saved << " points and " << this->rocks_saved_
                  << " rocks asleep when saved, " << asleep.at_end << " and " << this->rocks_at_end_ << " at the end, "
                  << this->contacts_saved_ << " contacts of both saved\n";
        EXPECT_GT(asleep.saved, 0);
        EXPECT_GT(this->rocks_saved_, 0);
        EXPECT_GT(this->contacts_saved_, 0);
        EXPECT_NE(asleep.at_end, asleep.saved);
    }
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
double furthest(Run<Exec>& run, Run<Exec>& other)
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

    Run<TypeParam> whole(this->exec(), text);
    whole.step(100);
    whole.save(path);
    whole.step(steps);
    double spread = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
    {
        std::filesystem::copy_file(path, moved, std::filesystem::copy_options::overwrite_existing);
        perturb(moved, 1e-9, seed);
        Run<TypeParam> repeat(this->exec(), text);
        repeat.load(moved, solver::Fidelity::exact);
        repeat.step(steps);
        spread = std::max(spread, furthest(whole, repeat));
    }
    Run<TypeParam> resumed(this->exec(), text);
    resumed.load(path, solver::Fidelity::physical);
    resumed.step(steps);
    const double off = furthest(whole, resumed);
    test::report("furthest that a point or body is off (m)", off, 0, spread,
                 "what five repeats come to of which everything was moved by up to 1e-9 m when the state was saved");
    EXPECT_LE(off, spread);
}

} // namespace
