#include "python/interface.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "base/errors.hpp"
#include "base/log.hpp"
#include "io/h5.hpp"
#include "python/requests.hpp"
#include "run/check.hpp"
#include "run/checkpoint_clock.hpp"
#include "run/features.hpp"
#include "run/on_ranks.hpp"
#include "scene/resolved.hpp"
#include "scene/soil_text.hpp"

struct tread_session
{
    tread::MpiSession mpi;
};

struct tread_visit
{
    tread::run::Visit& visit;
    std::string        why = "the visitor"; ///< the run stops
};

namespace tread::python
{
namespace
{

/// s, from one question whether the program goes on to the next: each takes Python's lock.
constexpr double poll_interval = 0.05;

/// Runs `work`, which returns an ExitCode; passes the message of an error to `answer`.
template<class F>
int guarded(tread_text answer, F work)
{
    try
    {
        return static_cast<int>(work());
    }
    catch (const std::exception& error)
    {
        answer(text_of(error).c_str());
        return static_cast<int>(code_of(error));
    }
}

/// EnvironmentError unless MPI runs and allows calls from this thread.
void require_mpi()
{
    int ended = 0, level = MPI_THREAD_SINGLE, is_main = 0;
    MPI_Finalized(&ended);
    if (ended != 0) { throw EnvironmentError("MPI has ended in this process: tread cannot be used any more"); }
    MPI_Query_thread(&level);
    MPI_Is_thread_main(&is_main);
    if (level < MPI_THREAD_FUNNELED)
    {
        throw EnvironmentError("MPI was started without threads; tread needs MPI_THREAD_FUNNELED at least");
    }
    if (level < MPI_THREAD_SERIALIZED && is_main == 0)
    {
        throw EnvironmentError("tread was called from another thread than the one that started MPI");
    }
}

std::string ask(const Json& request)
{
    const auto what = request.at("what").get<std::string>();
    if (what == "features") { return run::features(); }
    if (what == "soils") { return scene::soils_text(); }
    const Communicator alone(MPI_COMM_SELF);
    const scene::Scene scene = scene_of(alone, request);
    if (what == "resolved") { return scene::resolved_toml(scene); }
    const auto form = what == "check"    ? run::CheckForm::json
                      : what == "stages" ? run::CheckForm::page_with_stages
                                         : run::CheckForm::page;
    return run::check_scene(alone, scene, 1, form);
}

/// The calling program as a run sees it; `keeps` becomes true if it goes on reading fields.
run::Visitor visitor_of(const Json& request, const tread_calls& calls, bool& keeps)
{
    run::Visitor visitor;
    if (calls.visit != nullptr)
    {
        visitor.visit = [&calls, &keeps](run::Visit& visit)
        {
            tread_visit now{visit};
            const int   said = calls.visit(&now);
            keeps            = keeps || said == tread_stop_and_keep;
            return said == tread_go_on ? std::nullopt : std::optional<std::string>(now.why);
        };
    }
    visitor.every       = request.at("every").get<double>();
    visitor.every_steps = request.at("every_steps").get<std::int64_t>();
    visitor.stop_asked  = [&calls, last = run::wall_clock(), stopped = false]() mutable
    {
        if (stopped || run::wall_clock() - last < poll_interval) { return stopped; }
        stopped = calls.goes_on() == 0;
        last    = run::wall_clock();
        return stopped;
    };
    visitor.keeps_memory = [&keeps] { return keeps; };
    return visitor;
}

ExitCode run_request(const Json& request, const tread_calls& calls)
{
    const double       start = run::wall_clock();
    const Communicator world(communicator_of(request));
    const auto         watchdog = run::watch_ranks(world, request.at("hang_timeout").get<double>());
    try
    {
        bool               keeps = false;
        Log                log(world, request.at("terminal") == "shown" ? Terminal::shown : Terminal::silent);
        const scene::Scene scene   = scene_of(world, request);
        run::RunOptions    options = options_of(request);
        options.wall_start         = start;
        options.visitor            = visitor_of(request, calls, keeps);
        const ExitCode code        = run::run_scene(world, log, watchdog.get(), scene, options);
        world.all_arrive(std::numeric_limits<double>::infinity());
        return code;
    }
    catch (const std::exception& error)
    {
        run::require_all_failed(world, error);
        throw;
    }
}

} // namespace
} // namespace tread::python

using namespace tread;

int tread_begin(tread_session** session, tread_text answer)
{
    return python::guarded(answer,
                           [&]
                           {
                               io::h5::begin();
                               int begun = 0;
                               MPI_Initialized(&begun);
                               *session = begun == 0 ? std::make_unique<tread_session>().release() : nullptr;
                               python::require_mpi();
                               return ExitCode::finished;
                           });
}

void tread_end(tread_session* session)
{
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended == 0) { std::unique_ptr<tread_session>(session).reset(); }
}

int tread_ask(const char* request, tread_text answer)
{
    return python::guarded(answer,
                           [&]
                           {
                               python::require_mpi();
                               answer(python::ask(python::Json::parse(request)).c_str());
                               return ExitCode::finished;
                           });
}

int tread_run(const char* request, const tread_calls* calls, tread_text answer)
{
    return python::guarded(answer,
                           [&]
                           {
                               python::require_mpi();
                               return python::run_request(python::Json::parse(request), *calls);
                           });
}

int tread_visit_ask(tread_visit* visit, const char* request, tread_text answer)
{
    return python::guarded(answer,
                           [&]
                           {
                               const python::Json asked = python::Json::parse(request);
                               if (asked.at("what") == "stop") { visit->why = asked.at("why").get<std::string>(); }
                               else { answer(python::answer(visit->visit, asked).c_str()); }
                               return ExitCode::finished;
                           });
}

int tread_visit_field(tread_visit* visit, const char* name, tread_field* field, tread_text answer)
{
    return python::guarded(answer,
                           [&]
                           {
                               const auto found = visit->visit.field(name);
                               if (!found) { return ExitCode::finished; }
                               *field = {found->data,       static_cast<std::int32_t>(found->kind),
                                         found->bytes,      found->rows,
                                         found->columns,    found->row_step,
                                         found->column_step};
                               return ExitCode::finished;
                           });
}
