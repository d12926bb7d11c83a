#include <cstddef>
#include <cstdint>

#include "base/errors.hpp"
#include "edited_file.hpp"
#include "scratch_file.hpp"
#include "sound_bed.hpp"

// Reads a bed with changed values, rows and attributes: the result must be an EnvironmentError or a bed whose numbers
// are in range.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tread;
    static const fuzz::ScratchFile file(".h5");
    fuzz::write_edited(fuzz::originals() + "/bed.h5", file.path(), data, size);
    try
    {
        fuzz::require_sound(io::read_bed(file.path()));
    }
    catch (const EnvironmentError&)
    {
    }
    return 0;
}
