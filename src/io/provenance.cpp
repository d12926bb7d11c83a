#include "io/provenance.hpp"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/ranges.h>

#include "base/version.hpp"

namespace tread::io
{

std::string utc_now()
{
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                       fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

void write_provenance(const h5::File& file, const Provenance& provenance, const std::string& written)
{
    const auto write = [&](const char* name, const std::string& value) { h5::write_attribute(file, "/", name, value); };
    write("scene_hash", provenance.scene_hash);
    write("version", version);
    write("commit", commit());
    write("backend", provenance.backend);
    write("devices", fmt::format("{}", fmt::join(provenance.devices, "; ")));
    write("ranks", std::to_string(provenance.ranks));
    write("start", provenance.start);
    h5::set_fixed_attribute(file, "/", "written", written);
}

void stamp_written(const h5::File& file) { h5::set_fixed_attribute(file, "/", "written", utc_now()); }

} // namespace tread::io
