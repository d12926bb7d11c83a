#pragma once

namespace tread
{

/// Requests to a run from outside, in ascending order of priority.
enum class Request : int
{
    none,
    checkpoint, ///< and continue: USR1
    stop        ///< after a checkpoint: USR2, TERM, INT
};

/// Records USR1, USR2, TERM and INT while it lives, instead of ending the process; a second INT ends it. Only one may
/// exist at a time. Construction discards earlier requests.
class SignalWatch
{
public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch&)            = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

    /// Request of highest priority since the last call; a stop is kept.
    static Request take();

    /// Whether a stop was requested; take() reports it too.
    static bool stop_is_asked();

    /// Name of the last signal, as "USR2"; "" before any.
    static const char* last_name();
};

} // namespace tread
