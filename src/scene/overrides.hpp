#pragma once

#include <string>
#include <vector>

#include "scene/problems.hpp"

namespace tread::scene
{

/// Applies each override `a.b=c` to the document, with location "--set a.b=c"; later ones win. An override that cannot
/// be applied is a problem; unknown keys are found when the document is read.
void apply_overrides(Node& document, const std::vector<std::string>& overrides, Problems& problems);

} // namespace tread::scene
