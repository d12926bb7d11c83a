#pragma once

#include <string>
#include <vector>

namespace tread
{

/// This program becomes the Python script `name` ("jobs/study.py") with `arguments`, before which stand `--tread` and
/// the program's own path. The script is looked for in every folder above the program: as it is in a source tree, and
/// in `share/tread`. `TREAD_PYTHON` names another interpreter than Debian's. EnvironmentError where there is no script
/// or no Python.
[[noreturn]] void become_script(const std::string& name, const std::vector<std::string>& arguments);

} // namespace tread
