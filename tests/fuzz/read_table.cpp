#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "scene/ranges.hpp"
#include "scene/time_table.hpp"
#include "scratch_file.hpp"

// Feeds arbitrary bytes as the CSV of a prescribed motion: the result must be a fault with a line, or finite values at
// all times.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tread;
    static const fuzz::ScratchFile file(".csv");
    file.write(data, size);
    scene::TimeTable table{file.path(), "v", {}, {}};
    if (const auto fault = scene::read_time_table(table, scene::between(-10, 10), 2.0))
    {
        if (fault->what.empty() || fault->accepted.empty()) { std::abort(); }
        return 0;
    }
    for (const double time : {0.0, 0.5, 2.0})
    {
        if (!(std::abs(scene::value_at(table, time)) <= 10)) { std::abort(); }
    }
    return 0;
}
