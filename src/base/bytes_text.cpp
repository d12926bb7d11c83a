#include "base/bytes_text.hpp"

#include <fmt/format.h>

namespace tread
{

std::string bytes_text(std::int64_t bytes)
{
    const double value = static_cast<double>(bytes);
    if (value < 1e6) { return fmt::format("{:.1f} kB", value / 1e3); }
    if (value < 1e9) { return fmt::format("{:.1f} MB", value / 1e6); }
    if (value < 1e12) { return fmt::format("{:.2f} GB", value / 1e9); }
    if (value < 1e18) { return fmt::format("{:.4g} TB", value / 1e12); }
    return "over 1e6 TB";
}

} // namespace tread
