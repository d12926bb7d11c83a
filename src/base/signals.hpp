#pragma once

namespace tread
{

/// What somebody outside has asked of a run, the most last.
enum class Request : int
{
    none,
    checkpoint, ///< and go on: USR1
    stop        ///< after a checkpoint: USR2, TERM, INT
};

/// While one lives, USR1, USR2, TERM and INT are noted instead of ending the process; a second INT ends it. One at a
/// time. What was noted is forgotten when it is made.
class SignalWatch
{
public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch&)            = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

    /// The most that was asked for since the last call; a stop stays.
    static Request take();

    /// Whether a stop was asked for; take() says so too.
    static bool stop_is_asked();

    /// "USR2", of the last signal; "" before any.
    static const char* last_name();
};

} // namespace tread
