#include "run/run_output.hpp"

#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "io/files.hpp"
#include "run/checkpoint_clock.hpp"
#include "solver/state_file.hpp"
#include "world/saved_bed.hpp"
#include "world/saved_sand.hpp"

namespace tread::run
{
namespace
{

std::vector<io::NamedMesh> meshes(const world::World& world)
{
    std::vector<io::NamedMesh> named;
    for (const auto& form : world.templates) { named.push_back({form.name, form.mesh}); }
    return named;
}

/// Whether a loaded rotation is valid.
bool is_turn(const AxleTurn& turn)
{
    return std::isfinite(turn.spin) && std::isfinite(turn.angle) && std::isfinite(turn.driven) &&
           std::isfinite(turn.free) && turn.driven >= 0 && turn.free >= 0;
}

} // namespace

template<class Exec, class Real>
RunOutput<Exec, Real>::RunOutput(const OutputPlace& place, TimeLoop<Exec, Real>& loop)
    : place_(place)
    , loop_(loop)
    , surface_(place.scene, place.world)
    , turns_(place.scene.bodies.size())
{
    if (!place.plan.snapshots) { return; }
    io::SnapshotWriter files(place.communicator, place.directory.snapshots(), place.provenance);
    if (place.plan.bodies) { files.write_shapes(meshes(place.world)); }
    snapshots_.emplace(place.communicator, loop.simulation.exec(), std::move(files));
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::begin()
{
    const auto create = [&]
    { recorder_.emplace(place_.directory, place_.scene, place_.world, place_.communicator.size(), place_.provenance); };
    on_root(place_.communicator, create);
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::begin_phase()
{
    const std::vector<solver::BodyRow> bodies = loop_.simulation.named_bodies();
    surface_.press(bodies);
    surface_.renew(loop_.simulation.surface_heights(surface_.lattice()));
    surface_.press(bodies);
    on_root(place_.communicator, [&] { recorder_->begin_phase(loop_.phase.index, loop_.progress.time); });
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::after_step()
{
    for (std::size_t b = 0; b < turns_.size(); ++b) { add_step(turns_[b], loop_.commands[b], loop_.progress.last_dt); }
    write_due();
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::write_due()
{
    // A row needs a measured state and waits for the next measurement: measuring for its sake would change the steps
    // that follow.
    const double       time      = loop_.progress.time;
    const std::int64_t rows      = multiples(time, place_.scene.output.every);
    const std::int64_t snapshots = multiples(time, place_.scene.output.snapshots_every);
    if (rows > due_.rows && loop_.simulation.measured())
    {
        due_.rows = rows;
        write_row();
    }
    if (snapshots > due_.snapshots)
    {
        due_.snapshots = snapshots;
        write_snapshot();
    }
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::write_last()
{
    if (due_.last_row < loop_.progress.steps) { write_row(); }
    if (due_.last_snapshot < loop_.progress.steps) { write_snapshot(); }
}

/// Rows of the named bodies since the last call.
template<class Exec, class Real>
std::vector<solver::BodyRow> RunOutput<Exec, Real>::wheel_rows()
{
    auto bodies = loop_.simulation.named_bodies();
    surface_.press(bodies);
    turn_reactions(bodies, place_.scene, loop_.phase, loop_.motions);
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        bodies[b].surface = surface_.under(b, bodies[b]);
        bodies[b].power   = mean_power(turns_[b], bodies[b]);
        turns_[b]         = {spin_of(bodies[b])};
    }
    return bodies;
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::write_row()
{
    auto&      simulation = loop_.simulation;
    const auto write      = [&]
    {
        const double             time    = loop_.progress.time;
        const solver::Census     now     = simulation.census();
        const solver::EnergyRow  energy  = simulation.ledger().energy(now);
        const solver::BalanceRow balance = simulation.ledger().balance(now);
        const auto               bodies  = wheel_rows();
        const auto               joints  = simulation.joints();
        const auto*              ranks   = simulation.balance();
        const auto               on_file = [&]
        {
            if (ranks != nullptr) { recorder_->write_ranks(time, *ranks); }
            recorder_->write(time, bodies, energy, balance);
            recorder_->write_joints(time, joints);
            flush_if_due();
        };
        on_root(place_.communicator, on_file);
        answers_.add(place_.scene, loop_.phase, time, bodies);
        simulation.begin_mean();
    };
    loop_.clock.run(simulation.exec(), solver::stage::output, write);
    due_.last_row = loop_.progress.steps;
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::write_snapshot()
{
    if (!snapshots_) { return; }
    due_.last_snapshot = loop_.progress.steps;
    loop_.clock.run(loop_.simulation.exec(), solver::stage::snapshots,
                    [&] { snapshots_->write(loop_.progress.time, loop_.simulation); });
}

/// Opening the file and extending all its columns takes a millisecond a body: as long as several steps.
template<class Exec, class Real>
void RunOutput<Exec, Real>::flush_if_due()
{
    constexpr double between = 0.5; // s of wall time
    const double     now     = wall_clock();
    if (now - last_flush_ < between || !files_are_free()) { return; }
    recorder_->flush();
    last_flush_ = now;
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::keep_rows() noexcept
{
    if (!recorder_) { return; }
    try
    {
        recorder_->flush();
    }
    catch (const std::exception&) // the error that ends the run is the one to tell of
    {
    }
}

/// Rows wait while a snapshot is being written; an error of that snapshot is thrown here.
template<class Exec, class Real>
bool RunOutput<Exec, Real>::files_are_free()
{
    if (!snapshots_) { return true; }
    if (snapshots_->writing()) { return false; }
    snapshots_->finish();
    return true;
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::finish_snapshots()
{
    if (snapshots_) { snapshots_->finish(); }
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::finish()
{
    finish_snapshots();
    if (recorder_) { recorder_->flush(); }
}

template<class Exec, class Real>
std::string RunOutput<Exec, Real>::write_bed()
{
    finish_snapshots();
    auto&       simulation = loop_.simulation;
    io::BedFile bed        = world::make_bed(
               place_.scene, place_.world, io::gathered(place_.communicator, simulation.body_fields()), simulation.contacts());
    if (place_.plan.sand)
    {
        bed.points = world::saved_points(place_.communicator, place_.scene, place_.world, simulation.point_fields());
    }
    on_root(place_.communicator, [&] { io::write_bed(place_.directory.bed(), bed, place_.provenance); });
    return fmt::format("bed of {} rocks with {} contacts and {} points of sand: {}", bed.size(),
                       bed.contacts.stiffness.size(), bed.points.volume.size(), place_.directory.bed());
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::resume()
{
    due_.rows      = multiples(loop_.progress.time, place_.scene.output.every);
    due_.snapshots = multiples(loop_.progress.time, place_.scene.output.snapshots_every);
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::transfer(solver::StateFile& file, const std::string& checkpoint)
{
    surface_.transfer(file);
    file.common("run/turns", turns_,
                solver::accept::all(solver::accept::rows(turns_.size()),
                                    solver::accept::each("the rotation of an axle", is_turn)));
    std::vector<double> times = snapshots_ ? snapshots_->times() : std::vector<double>{};
    file.common("run/snapshots", times, solver::accept::all(solver::accept::finite(), solver::accept::ascending()));
    transfer_series(file, checkpoint);
    if (file.loads() && snapshots_) { snapshots_->resume(times); }
}

/// The checkpoint holds the time series as a file: rows up to here are safe whatever happens to it later, and later
/// ones are dropped on restart.
template<class Exec, class Real>
void RunOutput<Exec, Real>::transfer_series(solver::StateFile& file, const std::string& checkpoint)
{
    std::vector<std::uint8_t> bytes;
    const auto                read = [&]
    {
        recorder_->flush();
        const std::string text = io::read_file(place_.directory.time_series());
        bytes.assign(text.begin(), text.end());
    };
    if (!file.loads()) { on_root(place_.communicator, read); }
    file.common("run/timeseries", bytes, solver::accept::anything());
    if (file.loads())
    {
        on_root(place_.communicator, [&] { restore_series(bytes, checkpoint); });
    }
}

template<class Exec, class Real>
void RunOutput<Exec, Real>::restore_series(const std::vector<std::uint8_t>& bytes, const std::string& checkpoint)
{
    const std::string series = place_.directory.time_series(), received = series + ".received.tmp";
    const int         ranks = place_.communicator.size();
    io::write_atomically(received, std::string(bytes.begin(), bytes.end()));
    try
    {
        io::require_series(received, series_tables(place_.scene, ranks), checkpoint);
    }
    catch (...)
    {
        std::filesystem::remove(received);
        throw;
    }
    io::rename_file(received, series);
    recorder_.emplace(place_.directory, place_.scene, place_.world, ranks, place_.provenance,
                      io::SeriesFile::continued);
}

#define TREAD_INSTANTIATE(Exec, Real) template class RunOutput<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
