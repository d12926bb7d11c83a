#include "messages.hpp"

#include <algorithm>
#include <iostream>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "backend/vector.hpp"
#include "decomp/exchange.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "timed.hpp"

namespace tread::bench
{
namespace
{

/// Data that a point's contact needs at the start of a step.
struct PointState
{
    Vec3<double> position, velocity, support;
};

/// Rows 0 to `count` for every other rank for which `is_told` holds.
template<class IsTold>
std::vector<std::vector<std::int32_t>> rows_for(const Communicator& communicator, std::int64_t count, IsTold is_told)
{
    std::vector<std::int32_t> all(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::vector<std::int32_t>> rows(static_cast<std::size_t>(communicator.size()));
    for (int rank = 0; rank < communicator.size(); ++rank)
    {
        if (rank != communicator.rank() && is_told(rank)) { rows[static_cast<std::size_t>(rank)] = all; }
    }
    return rows;
}

template<class Exec>
class Messages
{
public:
    Messages(const Exec& exec, const Communicator& communicator, const MessagesCase& what)
        : exec_(exec)
        , communicator_(communicator)
        , transport_(communicator, exec, what.transport)
        , rounds_(what.rounds)
    {
    }

    const std::string& transport() const { return transport_.description(); }

    /// Time (s) of a substep of ranks that share `bodies` bodies.
    double send_shares(std::int64_t bodies)
    {
        decomp::Exchange<Exec> exchange(transport_, "shares");
        exchange.plan(rows_for(communicator_, bodies, [](int) { return true; }));
        Array<Exec, dem::WrenchShare> share(exec_, "share", bodies + exchange.received());
        share.fill_zero();
        const decomp::Columns columns = decomp::columns(share.data());
        return of_round(
            [&]
            {
                exchange.begin(columns);
                exchange.finish(columns, bodies);
            });
    }

    /// Time (s) to send `points` points of every other rank to the first rank, and their impulses back.
    double gather(std::int64_t points)
    {
        const bool             owns = communicator_.rank() == 0;
        decomp::Exchange<Exec> there(transport_, "points"), back(transport_, "impulses");
        there.plan(rows_for(communicator_, points, [](int rank) { return rank == 0; }));
        std::vector<std::int32_t> rows(static_cast<std::size_t>(there.received()));
        std::iota(rows.begin(), rows.end(), 0);
        back.plan(rows, there.from(), there.to());

        const std::int64_t        count = owns ? there.received() : points;
        Array<Exec, PointState>   state(exec_, "points", count);
        Array<Exec, Vec3<double>> impulse(exec_, "impulses", count);
        state.fill_zero();
        impulse.fill_zero();
        const decomp::Columns states = decomp::columns(state.data()), impulses = decomp::columns(impulse.data());
        return of_round(
            [&]
            {
                there.begin(states);
                there.finish(states, 0);
                back.begin(impulses);
                back.finish(impulses, 0);
            });
    }

private:
    /// Median of three times, each of the slowest rank.
    template<class Round>
    double of_round(Round round)
    {
        for (int i = 0; i < rounds_ / 10; ++i) { round(); }
        std::vector<double> times(3);
        for (double& time : times)
        {
            communicator_.barrier();
            const auto all = [&]
            {
                for (int i = 0; i < rounds_; ++i) { round(); }
            };
            const std::vector<double> each = communicator_.gather(timed(exec_, all) / rounds_);
            time                           = *std::max_element(each.begin(), each.end());
        }
        std::sort(times.begin(), times.end());
        return times[1];
    }

    Exec                    exec_;
    const Communicator&     communicator_;
    decomp::Transport<Exec> transport_;
    int                     rounds_;
};

} // namespace

void run_messages(const Communicator& communicator, const MessagesCase& what)
{
    const auto run = [&](const auto& exec)
    {
        Messages   messages(exec, communicator, what);
        const auto print = [&](const char* name, std::int64_t count, double seconds)
        {
            if (communicator.rank() > 0) { return; }
            std::cout << fmt::format("    {:<42}{:>8} {:9.1f} us\n", name, count, 1e6 * seconds) << std::flush;
        };
        if (communicator.rank() == 0)
        {
            std::cout << communicator.size() << " ranks, " << messages.transport() << "\n";
        }
        for (const std::int64_t bodies : {1, 100, 1000})
        {
            print("a substep's message, shared bodies", bodies, messages.send_shares(bodies));
        }
        for (const std::int64_t points : {1000, 10'000, 100'000})
        {
            print("a step's gather and way back, points a rank", points, messages.gather(points));
        }
    };
    on_backend(what.backend, run, communicator.local_rank());
}

} // namespace tread::bench
