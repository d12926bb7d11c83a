#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/errors.hpp"
#include "scene/load.hpp"
#include "scratch_file.hpp"

// Feeds arbitrary bytes as a scene: the result must be an InputError or a scene. Bytes before the first zero byte, if
// there is one, are a `--set`.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tread;
    static const fuzz::ScratchFile file(".toml");
    const auto* const              end  = data + size;
    const auto* const              zero = std::find(data, end, std::uint8_t{0});
    std::vector<std::string>       overrides;
    const auto*                    text = data;
    if (zero != end)
    {
        overrides.emplace_back(data, zero);
        text = zero + 1;
    }
    file.write(text, static_cast<std::size_t>(end - text));
    try
    {
        scene::load_scene(file.path(), overrides);
    }
    catch (const InputError&)
    {
    }
    return 0;
}
