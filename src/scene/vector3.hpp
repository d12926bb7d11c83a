#pragma once

#include <array>

namespace tread::scene
{

using Vector2 = std::array<double, 2>;
using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>; ///< rows

} // namespace tread::scene
