#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "base/errors.hpp"
#include "io/bed_file.hpp"
#include "scratch_file.hpp"

// Feeds arbitrary bytes as bed.h5: the result must be an EnvironmentError or a bed whose numbers are in range.
namespace
{

using namespace tread;

void require(bool holds)
{
    if (!holds) { std::abort(); }
}

void require_sound(const io::BedFile& bed)
{
    require(bed.position.size() == 3 * bed.size() && bed.orientation.size() == 4 * bed.size());
    for (const std::int32_t kind : bed.kind)
    {
        require(kind >= 0 && static_cast<std::size_t>(kind) < bed.kinds.size());
    }
    for (const double scale : bed.scale) { require(std::isfinite(scale) && scale > 0); }
    for (std::size_t i = 0; i < bed.contacts.pair.size(); i += 2)
    {
        require(bed.contacts.pair[i] >= 0 && static_cast<std::size_t>(bed.contacts.pair[i]) < bed.size());
    }
    for (const std::int32_t material : bed.points.material)
    {
        require(material >= 0 && static_cast<std::size_t>(material) < bed.points.materials.size());
    }
    for (const double mass : bed.points.mass) { require(std::isfinite(mass) && mass > 0); }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const fuzz::ScratchFile file(".h5");
    file.write(data, size);
    try
    {
        require_sound(io::read_bed(file.path()));
    }
    catch (const EnvironmentError&)
    {
    }
    return 0;
}
