#include "base/terminal.hpp"

#include <cstdlib>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace tread
{

Terminal terminal_here()
{
    const char* const kind    = std::getenv("TERM");
    const bool        redraws = kind != nullptr && *kind != '\0' && std::string_view(kind) != "dumb";
    return redraws && tcgetpgrp(STDOUT_FILENO) == getpgrp() ? Terminal::live : Terminal::shown;
}

int terminal_columns()
{
    winsize size{};
    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

} // namespace tread
