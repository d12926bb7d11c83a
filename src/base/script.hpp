#pragma once

#include <string>
#include <vector>

namespace tread
{

/// Replaces this process with the Python script `name` ("jobs/study.py"), passing `--tread`, the program's own path and
/// `arguments`. The script is that of the installation, `../share/tread` from the program's folder, or of the source
/// tree that the program was built from; no other folder is searched. `TREAD_PYTHON` names another interpreter than
/// Debian's. EnvironmentError if there is no script or no Python.
[[noreturn]] void become_script(const std::string& name, const std::vector<std::string>& arguments);

} // namespace tread
