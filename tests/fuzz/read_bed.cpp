#include <cstddef>
#include <cstdint>

#include "base/errors.hpp"
#include "scratch_file.hpp"
#include "sound_bed.hpp"

// Feeds arbitrary bytes as bed.h5: the result must be an EnvironmentError or a bed whose numbers are in range.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tread;
    static const fuzz::ScratchFile file(".h5");
    file.write(data, size);
    try
    {
        fuzz::require_sound(io::read_bed(file.path()));
    }
    catch (const EnvironmentError&)
    {
    }
    return 0;
}
