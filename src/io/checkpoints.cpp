#include "io/checkpoints.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <system_error>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/files.hpp"

namespace tread::io
{
namespace fs = std::filesystem;

namespace
{

std::vector<std::string> names_like(const std::string& directory, const char* pattern)
{
    std::vector<std::string> names;
    std::error_code          none;
    for (const auto& entry : fs::directory_iterator(directory, none))
    {
        const std::string name = entry.path().filename().string();
        if (std::regex_match(name, std::regex(pattern))) { names.push_back(name); }
    }
    return names;
}

void remove_one(const fs::path& path)
{
    std::error_code error;
    fs::remove(path, error);
    if (error) { throw EnvironmentError(fmt::format("{}: {}", path.string(), error.message())); }
}

} // namespace

std::string Checkpoints::path(std::int64_t step) const
{
    return fmt::format("{}/checkpoint_{:010}.h5", directory_, step);
}

std::optional<std::int64_t> Checkpoints::step_of(const std::string& path)
{
    std::smatch       parts;
    const std::string name = fs::path(path).filename().string();
    if (!std::regex_match(name, parts, std::regex("checkpoint_([0-9]{10,18})\\.h5"))) { return {}; }
    return std::stoll(parts[1]);
}

std::vector<std::string> Checkpoints::newest_first() const
{
    std::vector<std::string> paths;
    for (const std::string& name : names_like(directory_, "checkpoint_.*\\.h5"))
    {
        if (step_of(name)) { paths.push_back(directory_ + "/" + name); }
    }
    std::sort(paths.begin(), paths.end(),
              [](const std::string& a, const std::string& b) { return *step_of(a) > *step_of(b); });
    return paths;
}

void Checkpoints::prepare() const
{
    std::error_code error;
    fs::create_directories(directory_, error);
    if (error) { throw EnvironmentError(fmt::format("{}: {}", directory_, error.message())); }
    for (const std::string& name : names_like(directory_, ".*\\.tmp")) { remove_one(fs::path(directory_) / name); }
}

void Checkpoints::settle(const std::string& newest, int keep) const
{
    write_atomically(directory_ + "/latest", fs::path(newest).filename().string() + "\n");
    const std::vector<std::string> there = newest_first();
    for (std::size_t i = static_cast<std::size_t>(keep); i < there.size(); ++i) { remove_one(there[i]); }
}

void Checkpoints::remove_after(std::int64_t step) const
{
    for (const std::string& there : newest_first())
    {
        if (*step_of(there) > step) { remove_one(there); }
    }
}

} // namespace tread::io
