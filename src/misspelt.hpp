#pragma once

#include <string>

#include <CLI/CLI.hpp>

// Messages for command lines that cannot be understood.
namespace tread
{

/// Throws InputError, with the nearest one, if the first word is no subcommand.
void require_known_command(const CLI::App& app, int argc, char** argv);

/// Message for arguments that the parser refuses; names the nearest option where one is unknown. Ends with a newline.
std::string usage_message(const CLI::App* app, const CLI::Error& error);

} // namespace tread
