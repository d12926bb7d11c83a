#include "scene/time_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "scene/problems.hpp"
#include "scene/text.hpp"

namespace tread::scene
{
namespace
{

constexpr std::uintmax_t   most_bytes_of_table = std::uintmax_t{16} << 20; ///< some 10^6 rows
constexpr std::string_view time_column         = "time";

std::vector<std::string_view> cells_of(std::string_view line)
{
    std::vector<std::string_view> cells;
    for (std::size_t at = 0; at <= line.size();)
    {
        const auto end = std::min(line.find(',', at), line.size());
        cells.push_back(trimmed(line.substr(at, end - at)));
        at = end + 1;
    }
    return cells;
}

std::optional<double> number_in(std::string_view cell)
{
    double      value        = 0;
    const auto* end          = cell.data() + cell.size();
    const auto [rest, error] = std::from_chars(cell.data(), end, value);
    if (error != std::errc() || rest != end || !std::isfinite(value)) { return {}; }
    return value;
}

/// Index of a column by its name in the first line.
std::optional<std::size_t> index_of(const std::vector<std::string_view>& names, std::string_view name)
{
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) { return {}; }
    return static_cast<std::size_t>(at - names.begin());
}

std::string list_of(const std::vector<std::string_view>& names)
{
    std::string text;
    for (const std::string_view name : names) { text += (text.empty() ? "" : ", ") + std::string(name); }
    return shown(text, 200);
}

/// Reads lines of a table into its times and values.
class RowReader
{
public:
    RowReader(TimeTable& table, const Range& range)
        : table_(table)
        , range_(range)
    {
    }

    std::optional<TableFault> header(const std::string& line)
    {
        const auto names = cells_of(line);
        const auto time = index_of(names, time_column), value = index_of(names, table_.column);
        columns_ = names.size();
        if (!time) { return TableFault{1, "table", "the first line names no column `time`", "time, NAME, ..."}; }
        if (!value)
        {
            return TableFault{1, "column", fmt::format("there is no column \"{}\"", table_.column), list_of(names)};
        }
        time_  = *time;
        value_ = *value;
        return {};
    }

    std::optional<TableFault> row(std::size_t line, const std::string& text)
    {
        if (trimmed(text).empty()) { return {}; }
        const auto cells = cells_of(text);
        if (cells.size() != columns_)
        {
            return TableFault{line, "table", fmt::format("{} values", cells.size()),
                              fmt::format("{}, as the first line has", columns_)};
        }
        const auto time = number_in(cells[time_]), value = number_in(cells[value_]);
        if (!time) { return TableFault{line, "table", "the time is no finite number", "number (s)"}; }
        if (!value || !range_.contains(*value))
        {
            return TableFault{line, "table", fmt::format("\"{}\" is out of range", shown(std::string(cells[value_]))),
                              range_.text()};
        }
        if (!table_.time.empty() && *time <= table_.time.back())
        {
            return TableFault{line, "table", fmt::format("time {} does not come after {}", *time, table_.time.back()),
                              "increasing times"};
        }
        table_.time.push_back(*time);
        table_.value.push_back(*value);
        return {};
    }

private:
    TimeTable&   table_;
    const Range& range_;
    std::size_t  columns_ = 0, time_ = 0, value_ = 0;
};

std::optional<TableFault> read_rows(std::istream& stream, RowReader reader, std::size_t& line)
{
    std::string text;
    if (!std::getline(stream, text)) { return TableFault{1, "table", "the file is empty", "time, NAME, ..."}; }
    if (auto fault = reader.header(text)) { return fault; }
    while (std::getline(stream, text))
    {
        if (auto fault = reader.row(++line, text)) { return fault; }
    }
    return {};
}

} // namespace

std::optional<TableFault> read_time_table(TimeTable& table, const Range& range, double end)
{
    std::error_code error;
    const auto      bytes = std::filesystem::file_size(table.path, error);
    if (error) { return TableFault{1, "table", fmt::format("{} cannot be read", table.path), "CSV"}; }
    if (bytes > most_bytes_of_table)
    {
        return TableFault{1, "table", fmt::format("a file of {} bytes", bytes),
                          fmt::format("at most {} bytes", most_bytes_of_table)};
    }
    table.time.clear();
    table.value.clear();
    std::ifstream stream(table.path, std::ios::binary);
    std::size_t   line = 1;
    if (auto fault = read_rows(stream, {table, range}, line)) { return fault; }
    if (table.time.empty()) { return TableFault{line, "table", "the file has no row of numbers", "rows of numbers"}; }
    if (table.time.front() > 0)
    {
        return TableFault{2, "table", fmt::format("the table begins at {} s, after the phase", table.time.front()),
                          "a first time of 0 or before (s)"};
    }
    if (table.time.back() < end * (1 - 1e-12))
    {
        return TableFault{
            line, "table",
            fmt::format("the table ends at {} s, before the phase, which may take {} s", table.time.back(), end),
            fmt::format("a last time >= {} (s)", end)};
    }
    return {};
}

double value_at(const TimeTable& table, double time)
{
    const auto after = std::upper_bound(table.time.begin(), table.time.end(), time);
    if (after == table.time.begin()) { return table.value.front(); }
    if (after == table.time.end()) { return table.value.back(); }
    const auto   next  = static_cast<std::size_t>(after - table.time.begin());
    const double share = (time - table.time[next - 1]) / (table.time[next] - table.time[next - 1]);
    return table.value[next - 1] + share * (table.value[next] - table.value[next - 1]);
}

} // namespace tread::scene
