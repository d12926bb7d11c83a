#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "backend/instantiate.hpp"
#include "base/host_memory.hpp"
#include "io/checkpoint_file.hpp"
#include "io/checkpoints.hpp"
#include "run/driver.hpp"
#include "scene/resolved.hpp"
#include "solver/state_file.hpp"
#include "world/world_measures.hpp"

// Saves a run to a checkpoint, and restarts from it.
namespace tread::run
{
namespace
{

/// io::PhaseReport as doubles; the name is taken from the scene.
struct PhaseRow
{
    double start, time, end, settled, unbalanced, packing_fraction; ///< settled < 0: equilibrium was not requested
};

PhaseRow row_of(const io::PhaseReport& report)
{
    const double settled = !report.settled ? -1.0 : *report.settled ? 1.0 : 0.0;
    return {
        report.start, report.time,       static_cast<double>(end_kind(report.end)),
        settled,      report.unbalanced, report.packing_fraction.value_or(std::numeric_limits<double>::quiet_NaN())};
}

io::PhaseReport report_of(const std::string& name, const PhaseRow& row)
{
    const char*     end = name_of(static_cast<EndKind>(row.end));
    io::PhaseReport report{name, row.start, row.time, end, std::nullopt, row.unbalanced, std::nullopt};
    if (row.settled >= 0) { report.settled = row.settled > 0; }
    if (!std::isnan(row.packing_fraction)) { report.packing_fraction = row.packing_fraction; }
    return report;
}

/// Whether a loaded row is valid.
bool is_report(const PhaseRow& row)
{
    const double kind = row.end;
    return std::isfinite(row.start) && std::isfinite(row.time) && std::isfinite(row.unbalanced) &&
           !std::isinf(row.packing_fraction) && kind >= 0 && kind <= static_cast<double>(EndKind::unstopped) &&
           kind == std::floor(kind) && (row.settled == -1 || row.settled == 0 || row.settled == 1);
}

constexpr double latest     = 1e9;                ///< s of simulated time: some thirty years
constexpr double most_steps = 9007199254740992.0; ///< 2^53: doubles hold them exactly

constexpr const char* exact_word = "exact";

} // namespace

template<class Exec, class Real>
void Driver<Exec, Real>::write_checkpoint()
{
    const io::Checkpoints there(directory_.checkpoints());
    const std::string     path        = there.path(loop_.progress.steps);
    const double          start       = wall_clock();
    io::CheckpointReport& checkpoints = history_.checkpoints;
    const auto            write       = [&]
    {
        output_.finish_snapshots();
        io::CheckpointWriter writer(communicator_, path, state_bytes());
        writer.number("step", loop_.progress.steps);
        io::write_provenance(writer.file(), options_.provenance, communicator_.broadcast(io::utc_now()));
        writer.text("fidelity", exact_word);
        writer.text("scene", scene::resolved_toml(scene_));
        solver::StateFile file(communicator_, writer, solver::Fidelity::exact);
        transfer(file);
        const std::int64_t bytes = writer.finish();
        checkpoints.newest       = directory_.within(path);
        checkpoints.bytes += bytes;
        ++checkpoints.written;
        on_root(communicator_, [&] { there.settle(path, static_cast<int>(scene_.checkpoint.keep)); });
        return bytes;
    };
    std::int64_t bytes = 0;
    loop_.clock.run_timed(solver::stage::checkpoints, [&] { bytes = write(); });
    const double seconds = wall_clock() - start;
    checkpoints.seconds += seconds;
    const RunProgress& progress = loop_.progress;
    checkpoint_clock_->written(progress.time, progress.steps, seconds);
    log_.info(fmt::format("checkpoint at {:.6g} s, step {}: {}, {:.3g} MB in {:.3g} s", progress.time, progress.steps,
                          checkpoints.newest, static_cast<double>(bytes) / 1e6, seconds));
}

/// If the checkpoint is refused, restores the directory. The error may be on one rank only.
template<class Exec, class Real>
void Driver<Exec, Real>::resume()
{
    try
    {
        load_checkpoint();
    }
    catch (...)
    {
        output_.close();
        if (communicator_.rank() == 0) { directory_.undo(); }
        throw;
    }
    world::release_rocks(world_);
    return_freed_memory();
    ++history_.restarts;
    output_.resume();
    const RunProgress& progress = loop_.progress;
    on_root(communicator_, [&] { io::Checkpoints(directory_.checkpoints()).remove_after(progress.steps); });
    messages_ = {wall_clock(), progress.steps, progress.time, messages_.warned};
    // The scene may have shortened the phase.
    if (progress.time >= latest_end(scene_, loop_.phase) - time_rounding) { end_phases(loop_, calls()); }
}

template<class Exec, class Real>
void Driver<Exec, Real>::load_checkpoint()
{
    std::unique_ptr<io::CheckpointReader> reader;
    on_every_rank(communicator_, [&] { reader = std::make_unique<io::CheckpointReader>(options_.checkpoint); });
    int  ranks = 0;
    bool exact = false;
    on_every_rank(communicator_,
                  [&]
                  {
                      ranks = static_cast<int>(reader->first_rows("simulation/pace").size()) - 1;
                      exact = reader->text("fidelity") == exact_word && ranks == communicator_.size();
                  });
    solver::StateFile file(communicator_, *reader, exact ? solver::Fidelity::exact : solver::Fidelity::physical);
    transfer(file);
    io::CheckpointReport& checkpoints = history_.checkpoints;
    checkpoints.newest                = directory_.within(options_.checkpoint);
    // The sum saved in a checkpoint does not include that file.
    checkpoints.bytes += static_cast<std::int64_t>(std::filesystem::file_size(options_.checkpoint));
    ++checkpoints.written;
    log_.info(fmt::format("goes on from {} at {:.6g} s, step {}, in phase '{}'{}", options_.checkpoint,
                          loop_.progress.time, loop_.progress.steps, keys_of(scene_, loop_.phase).name,
                          exact ? "" : fmt::format(" (written by {} rank(s): the same to rounding)", ranks)));
}

template<class Exec, class Real>
void Driver<Exec, Real>::transfer(solver::StateFile& file)
{
    require_same_world(file);
    simulation_.transfer(file);
    run::transfer(file, scene_, loop_.phase, loop_.watch);
    run::transfer(file, scene_, loop_.motions);
    loop_.clock.transfer(file);
    RunProgress& progress = loop_.progress;
    double       wall     = wall_time();
    file.numbers("run/steps", solver::accept::number(progress.time, 0, latest),
                 solver::accept::number(progress.steps, 0, most_steps), progress.substeps,
                 solver::accept::number(progress.chosen.dt, 0, solver::accept::largest), progress.chosen.substeps,
                 messages_.warned, wall, history_.restarts);
    io::CheckpointReport& checkpoints = history_.checkpoints;
    file.numbers("run/checkpoints", checkpoints.written, checkpoints.bytes, checkpoints.seconds);
    file.text("limit", progress.chosen.limit);
    if (file.loads()) { history_.wall = wall; }
    std::vector<PhaseRow> ended;
    for (const io::PhaseReport& report : ended_) { ended.push_back(row_of(report)); }
    const auto all_that_ended = [&](const std::vector<PhaseRow>& rows)
    {
        const std::size_t index = loop_.phase.index;
        return rows.size() == index ? solver::accept::Verdict{} : solver::accept::rows(index)(rows);
    };
    file.common("run/phases", ended,
                solver::accept::all(all_that_ended, solver::accept::each("the report of a phase", is_report)));
    ended_.clear();
    for (std::size_t p = 0; p < ended.size(); ++p) { ended_.push_back(report_of(scene_.phases[p].name, ended[p])); }
    output_.transfer(file, options_.checkpoint);
}

template<class Exec, class Real>
void Driver<Exec, Real>::require_same_world(solver::StateFile& file) const
{
    const std::vector<double> here  = world::measures(world_, body_measures_);
    std::vector<double>       there = here;
    file.common("run/world", there, solver::accept::all(solver::accept::rows(here.size()), solver::accept::finite()));
    if (world::are_same(here, there)) { return; }
    throw InputError(
        fmt::format("{}: the scene builds other points or bodies than when this was written: a file that it "
                    "names (mesh, heights, bed) has changed since",
                    options_.checkpoint));
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void Driver<Exec, Real>::write_checkpoint();                                                              \
    template void Driver<Exec, Real>::resume()
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
