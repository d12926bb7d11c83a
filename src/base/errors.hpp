#pragma once

#include <stdexcept>
#include <string>

#include "base/exit_code.hpp"

namespace tread
{

/// Every error that ends a run carries the exit code that it ends with.
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

/// The computation cannot go on: names what, where, when and which limit: exit 3.
struct NumericalError : Error
{
    explicit NumericalError(const std::string& message)
        : Error(ExitCode::numerical, message)
    {
    }
};

/// The machine cannot do what is asked: no GPU, no space, no permission, MPI: exit 4.
struct EnvironmentError : Error
{
    explicit EnvironmentError(const std::string& message)
        : Error(ExitCode::environment, message)
    {
    }
};

/// Somebody asked the run to stop while it was in a step, of which no checkpoint can be written: exit 75.
struct StoppedInStep : Error
{
    explicit StoppedInStep(const std::string& message)
        : Error(ExitCode::stopped_early, message)
    {
    }
};

/// What the process returns when it ends with this: of an Error its own, of no memory and of the system's errors that
/// of the machine, of anything else that of a computation that cannot go on.
ExitCode code_of(const std::exception& error);

/// What is said of it, printable.
std::string text_of(const std::exception& error);

} // namespace tread
