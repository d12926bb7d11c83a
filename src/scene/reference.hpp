#pragma once

#include <string>

namespace tread::scene
{

/// Text of docs/scene.md: every key of a scene with unit, default, accepted values and meaning.
std::string reference_markdown();

} // namespace tread::scene
