#pragma once

#include <cstdint>

// C interface of libtread_python, which src/python/tread/library.py mirrors. Requests and answers are JSON, but for the
// fields of a visit. Every function returns an ExitCode as int and throws nothing; `answer` gets the answer or, with
// any other code than 0, the message of the error. Texts are UTF-8 and valid during the call.
extern "C"
{
    using tread_text = void (*)(const char* text);

    struct tread_session;
    struct tread_visit;

    /// Calls to the program that runs a scene. A visit returns one of `tread_answer`; `goes_on` 0 to stop the run.
    struct tread_calls
    {
        int (*visit)(tread_visit* visit); ///< null: none
        int (*goes_on)();
    };

    /// What a visit returns. `stop` is 0, which a callback returns that has failed.
    enum tread_answer
    {
        tread_stop          = 0,
        tread_go_on         = 1,
        tread_stop_and_keep = 2, ///< fields of the visit are still read: they must not be freed
    };

    /// run::HostArray.
    struct tread_field
    {
        const void*  data;
        std::int32_t kind;
        std::int32_t bytes;
        std::int64_t rows;
        std::int64_t columns;
        std::int64_t row_step;
        std::int64_t column_step;
    };

    /// Starts MPI unless the process has done so; `session` is null then. Call it once, before all others.
    int tread_begin(tread_session** session, tread_text answer);

    /// Ends MPI, if `session` has started it and nobody has ended it.
    void tread_end(tread_session* session);

    /// {"what": "check" | "report" | "stages" | "resolved", "scene": SCENE} or {"what": "features" | "soils"}.
    int tread_ask(const char* request, tread_text answer);

    /// Runs a scene (run::run_scene). The code of a run that was stopped or failed comes without a message: it has left
    /// a summary.
    int tread_run(const char* request, const tread_calls* calls, tread_text answer);

    /// {"what": "when"}, {"what": "body" | "joint", "name": NAME}, {"what": "steer body" | "steer motor", "name": NAME,
    /// ...}, {"what": "stop", "why": TEXT}.
    int tread_visit_ask(tread_visit* visit, const char* request, tread_text answer);

    /// Finds a field; `data` stays as it is where the scene does not have it.
    int tread_visit_field(tread_visit* visit, const char* name, tread_field* field, tread_text answer);
}
