#pragma once

namespace tread
{

constexpr int      warp_size = 32;
constexpr unsigned all_lanes = 0xffffffffu;

} // namespace tread
