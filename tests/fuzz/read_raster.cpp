#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "base/errors.hpp"
#include "scratch_file.hpp"
#include "world/raster.hpp"

// Feeds arbitrary bytes as a height map: the result must be an InputError or finite heights, rows times columns of
// them. The first byte selects the format: 0 = PGM, 1 = CSV.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tread;
    static const fuzz::ScratchFile picture(".pgm"), table(".csv");
    if (size == 0) { return 0; }
    const fuzz::ScratchFile& file = data[0] % 2 == 0 ? picture : table;
    file.write(data + 1, size - 1);
    scene::RasterFile named;
    named.path = file.path();
    named.low  = 0.0;
    named.high = 1.0;
    try
    {
        const world::Raster raster = world::read_raster(named);
        if (raster.heights.size() != raster.columns * raster.rows) { std::abort(); }
        for (const double height : raster.heights)
        {
            if (!std::isfinite(height)) { std::abort(); }
        }
    }
    catch (const InputError&)
    {
    }
    return 0;
}
