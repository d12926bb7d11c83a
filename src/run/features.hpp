#pragma once

#include <string>

namespace tread::run
{

/// What this program was built from and with, for bug reports: version, commit, backends, processor, libraries. One
/// line each.
std::string features();

} // namespace tread::run
