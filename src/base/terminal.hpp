#pragma once

namespace tread
{

enum class Terminal
{
    live,  ///< shown, with a last line that is redrawn
    shown, ///< line after line
    silent
};

/// Kind of terminal that standard output is: live if this process is in its foreground and it can redraw a line (TERM
/// is set and not "dumb"), else shown. MPI's launchers put a terminal of their own between, which counts as shown.
Terminal terminal_here();

/// Width of standard output; 80 if it has none.
int terminal_columns();

} // namespace tread
