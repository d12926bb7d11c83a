#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "harness.hpp"
#include "run/time_loop.hpp"
#include "solver/state_file.hpp"
#include "temporary_directory.hpp"

// A run that is stopped and resumed from a checkpoint, compared with an uninterrupted one.
namespace tread::test
{

inline const std::string rocks_alone = R"(
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
class SavedRun
{
public:
    SavedRun(const Exec& exec, const std::string& text)
        : scene_(load_text(text))
        , world_(world::build_world(scene_))
        , simulation_(exec, scene_, world_, solver::make_plan(scene_, world_))
        , loop_(scene_, world_, simulation_)
    {
        simulation_.begin();
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
inline std::int64_t rows_of(const std::string& path, const std::string& name)
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
class RestartTest : public BackendTest<Exec>
{
protected:
    static constexpr int before = 150, after = 150; ///< steps; lists of points, pairs and candidates change in both

    /// Returns the numbers of points that slept.
    Sleepers expect_same_bits(const std::string& text)
    {
        const TemporaryDirectory directory;
        const std::string        path = directory.path("state.h5");

        SavedRun<Exec> whole(this->exec(), text);
        whole.step(before);
        whole.step(after);

        SavedRun<Exec> stopped(this->exec(), text);
        stopped.step(before);
        stopped.save(path);
        phase_saved_              = stopped.phase();
        time_saved_               = stopped.time();
        const std::int64_t asleep = stopped.asleep();
        rocks_saved_              = stopped.rocks_asleep();
        contacts_saved_           = rows_of(path, "contact/asleep_key");
        SavedRun<Exec> resumed(this->exec(), text);
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

} // namespace tread::test
