#include "base/script.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.hpp"

namespace tread
{
namespace
{

namespace fs = std::filesystem;

fs::path this_program()
{
    std::error_code error;
    fs::path        path = fs::read_symlink("/proc/self/exe", error);
    if (error) { throw EnvironmentError(fmt::format("/proc/self/exe: {}", error.message())); }
    return path;
}

/// Looks beside an installed program (bin, share), or in the source tree that this program was built from.
fs::path find_script(const fs::path& program, const std::string& name)
{
    const fs::path installed = program.parent_path().parent_path() / "share" / "tread" / name;
    const fs::path source    = fs::path(TREAD_SOURCE_DIRECTORY) / name;
    for (const fs::path& script : {installed, source})
    {
        std::error_code error;
        if (fs::is_regular_file(script, error)) { return script; }
    }
    throw EnvironmentError(fmt::format("{} is part of tread's sources; it is neither {} nor {}", name,
                                       installed.string(), source.string()));
}

} // namespace

void become_script(const std::string& name, const std::vector<std::string>& arguments)
{
    const fs::path    program = this_program();
    const char* const named   = std::getenv("TREAD_PYTHON");
    // Debian's Python has the packages that the scripts use; another one may come first on PATH.
    std::vector<std::string> words{named != nullptr ? named : "/usr/bin/python3", find_script(program, name).string(),
                                   "--tread", program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) { pointers.push_back(word.data()); }
    pointers.push_back(nullptr);
    execvp(pointers.front(), pointers.data());
    throw EnvironmentError(fmt::format(
        "{} needs Python 3.11 with h5py, numpy and matplotlib: {}: {}; TREAD_PYTHON names another interpreter", name,
        words.front(), std::strerror(errno)));
}

} // namespace tread
