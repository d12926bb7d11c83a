#pragma once

#include <string>
#include <vector>

#include "scene/problems.hpp"

namespace tread::scene
{

/// Writes each `a.b=c` into the document as if it stood there, located at "--set a.b=c"; later ones win.
/// An override that cannot be placed is a problem; an unknown key is found when the document is read.
void apply_overrides(Node& document, const std::vector<std::string>& overrides, Problems& problems);

} // namespace tread::scene
