#pragma once

#include <string>
#include <vector>

namespace tread
{

/// This program becomes the Python script `name` ("jobs/study.py") with `arguments`, before which stand `--tread` and
/// the program's own path. The script is that of the installation, `../share/tread` from the program's folder, or of
/// the sources that the program was built from; no other folder is searched. `TREAD_PYTHON` names another interpreter
/// than Debian's. EnvironmentError where there is no script or no Python.
[[noreturn]] void become_script(const std::string& name, const std::vector<std::string>& arguments);

} // namespace tread
