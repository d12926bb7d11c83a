#pragma once

#include <stdexcept>
#include <string>

#include "base/exit_code.hpp"

namespace tread
{

/// Base of errors that end a run; carries the exit code.
class Error : public std::runtime_error
{
public:
    Error(ExitCode code, const std::string& message)
        : std::runtime_error(message)
        , code_(code)
    {
    }

    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// The scene, a mesh or the command line is wrong: exit 2 before anything is written.
struct InputError : Error
{
    explicit InputError(const std::string& message)
        : Error(ExitCode::bad_input, message)
    {
    }
};

/// The computation cannot continue; the message names what, where, when and which limit: exit 3.
struct NumericalError : Error
{
    explicit NumericalError(const std::string& message)
        : Error(ExitCode::numerical, message)
    {
    }
};

/// The machine cannot provide what is needed: no GPU, no space, no permission, MPI: exit 4.
struct EnvironmentError : Error
{
    explicit EnvironmentError(const std::string& message)
        : Error(ExitCode::environment, message)
    {
    }
};

/// A stop was requested during a step, when no checkpoint can be written: exit 75.
struct StoppedInStep : Error
{
    explicit StoppedInStep(const std::string& message)
        : Error(ExitCode::stopped_early, message)
    {
    }
};

/// Exit code for an exception: an Error's own; environment for out of memory and system errors; numerical for all
/// others.
ExitCode code_of(const std::exception& error);

/// Printable message of an exception.
std::string text_of(const std::exception& error);

} // namespace tread
