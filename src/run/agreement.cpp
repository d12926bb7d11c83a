#include "run/agreement.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "io/checksum.hpp"
#include "scene/differences.hpp"
#include "scene/input_files.hpp"

namespace tread::run
{
namespace
{

constexpr std::size_t most_lines = 20; ///< lines of a message per rank

/// Size and checksum of a file, as read by this rank.
std::string contents(const Communicator& alone, const std::string& path)
{
    std::error_code error;
    const auto      bytes = std::filesystem::file_size(path, error);
    if (error) { throw EnvironmentError(fmt::format("{}: {}", path, error.message())); }
    return fmt::format("{} bytes, checksum {:016x}", bytes,
                       io::checksum(alone, path, 0, static_cast<std::int64_t>(bytes)));
}

std::string restart_text(const RestartOptions& restart)
{
    switch (restart.mode)
    {
    case RestartMode::none:
        return "none";
    case RestartMode::automatic:
        return "auto";
    case RestartMode::file:
        break;
    }
    return restart.file;
}

const char* word_of(decomp::TransportChoice transport)
{
    switch (transport)
    {
    case decomp::TransportChoice::automatic:
        return "auto";
    case decomp::TransportChoice::mpi:
        return "mpi";
    case decomp::TransportChoice::nccl:
        return "nccl";
    case decomp::TransportChoice::host:
        break;
    }
    return "host";
}

constexpr char separator = '\0'; ///< occurs in no path and no option

std::string text_of(const std::vector<Fact>& facts)
{
    std::string text;
    for (const Fact& fact : facts) { text += fact.name + separator + fact.value + separator; }
    return text;
}

std::vector<Fact> facts_of(const std::string& text)
{
    std::istringstream lines(text);
    std::vector<Fact>  facts;
    Fact               fact;
    while (std::getline(lines, fact.name, separator) && std::getline(lines, fact.value, separator))
    {
        facts.push_back(fact);
    }
    return facts;
}

std::string shown(const std::string& value) { return value.empty() ? "none" : value; }

void add_line(const std::string& name, const std::string& here, const std::string& on_rank_0,
              std::vector<std::string>& lines)
{
    lines.push_back(fmt::format("{}: {}; rank 0 has {}", name, shown(here), shown(on_rank_0)));
}

std::vector<std::string> fact_lines(const std::vector<Fact>& here, const std::vector<Fact>& on_rank_0)
{
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < std::max(here.size(), on_rank_0.size()); ++i)
    {
        const Fact a = i < here.size() ? here[i] : Fact{}, b = i < on_rank_0.size() ? on_rank_0[i] : Fact{};
        if (a.name != b.name) { add_line("input", a.name, b.name, lines); }
        else if (a.value != b.value) { add_line(a.name, a.value, b.value, lines); }
    }
    return lines;
}

void add_scene_lines(const std::string& here, const std::string& on_rank_0, std::vector<std::string>& lines)
{
    if (here == on_rank_0) { return; }
    const std::vector<scene::Difference> found = scene::differences(on_rank_0, here);
    for (const scene::Difference& difference : found)
    {
        add_line(scene::place_of(difference), difference.is, difference.was, lines);
    }
    if (found.empty()) { lines.emplace_back("the scene is written otherwise than on rank 0"); }
}

std::string indented(const std::vector<std::string>& lines)
{
    std::string text;
    for (std::size_t i = 0; i < std::min(lines.size(), most_lines); ++i) { text += "\n    " + lines[i]; }
    if (lines.size() > most_lines) { text += fmt::format("\n    and {} more", lines.size() - most_lines); }
    return text;
}

} // namespace

scene::Scene load_on_every_rank(const Communicator& communicator, const std::string& path,
                                const std::vector<std::string>& overrides)
{
    scene::Scene scene;
    on_every_rank(communicator, [&] { scene = scene::load_scene(path, overrides); });
    return scene;
}

scene::Scene load_on_every_rank(const Communicator& communicator, const scene::SceneText& source,
                                const std::vector<std::string>& overrides)
{
    scene::Scene scene;
    on_every_rank(communicator, [&] { scene = scene::load_scene(source, overrides); });
    return scene;
}

std::vector<Fact> facts_of_run(const scene::Scene& scene, const RunOptions& options, const std::string& backend)
{
    const auto        given = [](bool is) { return is ? "given" : "not given"; };
    std::vector<Fact> facts{
        {"program", fmt::format("tread {} ({})", version, commit())},
        {"backend", backend},
        {"run directory", std::filesystem::absolute(options.output).lexically_normal().string()},
        {"--overwrite", given(options.existing == io::Existing::overwrite)},
        {"--restart", restart_text(options.restart)},
        {"--walltime-limit", fmt::format("{} s", options.walltime_limit)},
        {"--transport", word_of(options.decomposition.transport)},
        {"--checksums", given(options.decomposition.checksums == decomp::Checksums::on)},
        {"--share-gpus", given(options.gpus == GpuSharing::allowed)},
    };
    const Communicator alone(MPI_COMM_SELF);
    for (const scene::InputFile& file : scene::input_files(scene))
    {
        facts.push_back({fmt::format("{} {}", file.key, file.path), contents(alone, file.path)});
    }
    return facts;
}

void require_agreement(const Communicator& communicator, const std::string& scene, const std::vector<Fact>& facts)
{
    if (communicator.size() == 1) { return; }
    const std::string        scene_of_rank_0 = communicator.broadcast(scene);
    std::vector<std::string> lines           = fact_lines(facts, facts_of(communicator.broadcast(text_of(facts))));
    add_scene_lines(scene, scene_of_rank_0, lines);
    const std::string own =
        lines.empty() ? "" : fmt::format("\n  rank {} on {}{}", communicator.rank(), host_name(), indented(lines));
    std::string all;
    for (const std::string& text : communicator.gather(own)) { all += text; }
    if (all.empty()) { return; }
    throw EnvironmentError(fmt::format("the ranks are not about to run the same, compared with rank 0 on {}:{}",
                                       communicator.broadcast(host_name()), all));
}

} // namespace tread::run
