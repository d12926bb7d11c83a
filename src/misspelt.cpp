#include "misspelt.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/printable.hpp"
#include "scene/problems.hpp"

namespace tread
{
namespace
{

std::vector<std::string> option_names(const CLI::App& command)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
    {
        for (const std::string& name : option->get_lnames()) { names.push_back("--" + name); }
    }
    return names;
}

} // namespace

void require_known_command(const CLI::App& app, int argc, char** argv)
{
    const std::string word = argc > 1 ? argv[1] : "--help";
    if (word.rfind('-', 0) == 0) { return; }
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) { names.push_back(command->get_name()); }
    if (std::find(names.begin(), names.end(), word) != names.end()) { return; }
    throw InputError(fmt::format("there is no command \"{}\"{}; accepted: {} (tread --help)", printable(word),
                                 scene::suggestion(word, names), fmt::join(names, ", ")));
}

std::string usage_message(const CLI::App* app, const CLI::Error& error)
{
    std::string near, name = app->get_name();
    for (const CLI::App* command : app->get_subcommands())
    {
        name += " " + command->get_name();
        const std::vector<std::string> unknown = command->remaining();
        if (!unknown.empty()) { near = scene::suggestion(unknown.front(), option_names(*command)); }
    }
    return fmt::format("tread: error: {}{} ({} --help)\n", printable(error.what()), near, name);
}

} // namespace tread
