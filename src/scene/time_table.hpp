#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/motion.hpp"
#include "scene/values.hpp"

namespace tread::scene
{

/// What is wrong with a table.
struct TableFault
{
    std::size_t line; ///< counts from 1
    std::string key;  ///< "table" or "column"
    std::string what;
    std::string accepted;
};

/// Reads the times and values of the table's file; values must be in `range`, and the times must cover 0 to `end` (s).
std::optional<TableFault> read_time_table(TimeTable& table, const Range& range, double end);

/// Value at a time (s): linear between rows, constant beyond the first and the last.
double value_at(const TimeTable& table, double time);

} // namespace tread::scene
