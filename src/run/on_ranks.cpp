#include "run/on_ranks.hpp"

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/wait_board.hpp"
#include "io/h5.hpp"

namespace tread::run
{
namespace
{

/// Ends this process alone; the launcher then ends the others, which may first report what they wait for.
[[noreturn]] void end_hanging_rank(const std::string& name, const std::string& complaint)
{
    constexpr std::chrono::seconds for_others{5};
    std::cerr << fmt::format("tread: error: {}: {}; --hang-timeout allows for more", name, complaint) << std::endl;
    std::this_thread::sleep_for(for_others);
    std::_Exit(static_cast<int>(ExitCode::environment));
}

/// Ends all ranks, since only this one has failed.
[[noreturn]] void abort_ranks(const Communicator& world, const std::exception& error)
{
    std::cerr << "tread: error: rank " << world.rank() << " on " << host_name() << ": " << tread::text_of(error)
              << std::endl;
    world.abort(code_of(error));
}

/// Runs the command on all ranks; returns the worst of their exit codes. Throws errors of the final agreement.
ExitCode run_together(const Communicator& world, const std::function<ExitCode(const Communicator&)>& command)
{
    ExitCode code = ExitCode::finished;
    try
    {
        code = command(world);
        world.all_arrive(std::numeric_limits<double>::infinity());
    }
    catch (const std::exception& error)
    {
        code = code_of(error);
        require_all_failed(world, error);
        if (world.rank() == 0) { std::cerr << "tread: error: " << tread::text_of(error) << std::endl; }
    }
    return static_cast<ExitCode>(world.maximum(static_cast<std::int64_t>(code)));
}

/// Who has not come to the collective call that this rank waits in.
std::string absent_text(const WaitBoard& board)
{
    const std::vector<int> behind = board.behind();
    if (behind.empty()) { return "to which all of this node have come"; }
    return fmt::format("to which {} of this node {} not come", ranks_text(behind), behind.size() == 1 ? "has" : "have");
}

} // namespace

ExitCode on_ranks(const std::function<ExitCode(const Communicator&)>& command)
{
    io::h5::begin();
    const MpiSession session;
    try
    {
        return run_together(session.world(), command);
    }
    catch (const std::exception& error)
    {
        abort_ranks(session.world(), error); // other ranks may wait for this one, and MPI_Finalize would wait for them
    }
}

void require_all_failed(const Communicator& world, const std::exception& error)
{
    if (!world.all_arrive(agreement_timeout)) { abort_ranks(world, error); }
}

std::unique_ptr<Watchdog> watch_ranks(const Communicator& world, double timeout)
{
    if (world.size() == 1) { return nullptr; }
    const std::string            name  = fmt::format("rank {} on {}", world.rank(), host_name());
    const auto                   board = std::make_shared<const WaitBoard>(world);
    std::function<std::string()> absent;
    if (!board->is_empty())
    {
        absent = [board] { return absent_text(*board); };
    }
    return std::make_unique<Watchdog>(
        world.waits(), std::chrono::duration<double>(timeout),
        [name](const std::string& complaint) { end_hanging_rank(name, complaint); }, absent);
}

} // namespace tread::run
