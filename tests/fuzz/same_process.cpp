#include "base/errors.hpp"
#include "io/in_child.hpp"

// Stands in for the child process that reads a received file first, for files that HDF5 can bear: a process for each
// execution would take most of the time.
namespace tread::io
{

std::string run_in_child(const std::string& /*what*/, const std::function<std::string()>& work,
                         const ChildLimits& /*limits*/)
{
    try
    {
        return work();
    }
    catch (const std::exception& error)
    {
        throw EnvironmentError(error.what());
    }
}

} // namespace tread::io
