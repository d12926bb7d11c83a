#include "io/time_series.hpp"

#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/describe.hpp"
#include "io/h5.hpp"
#include "io/in_child.hpp"

namespace tread::io
{
namespace
{

constexpr const char* series_schema = "tread-timeseries";

void require_growing(const h5::File& file, const SeriesTable& table)
{
    for (const Column& column : table.columns)
    {
        h5::require_growing(file, table.group + "/" + column.name, column.width);
    }
}

} // namespace

void require_series(const std::string& path, const std::vector<SeriesTable>& tables, const std::string& checkpoint)
{
    const auto look = [&]
    {
        describe_here(path);
        const h5::File file = h5::File::open_received(path);
        for (const SeriesTable& table : tables)
        {
            if (h5::holds(file, table.group)) { require_growing(file, table); }
        }
        return h5::read_text_attribute(file, "/", "schema");
    };
    std::string schema;
    try
    {
        schema = run_in_child(path, look);
    }
    catch (const EnvironmentError& error)
    {
        throw EnvironmentError(
            fmt::format("{}: the checkpoint cannot be used: run/timeseries: {}", checkpoint, error.what()));
    }
    if (schema == series_schema) { return; }
    throw EnvironmentError(fmt::format("{}: the checkpoint cannot be used: run/timeseries: its schema is \"{}\"; "
                                       "accepted: \"{}\"",
                                       checkpoint, schema, series_schema));
}

TimeSeries::TimeSeries(std::string path, const Provenance& provenance, SeriesFile series)
    : path_(std::move(path))
{
    if (series == SeriesFile::continued) { return; }
    h5::File file = h5::File::create(path_);
    h5::write_attribute(file, "/", "schema", std::string(series_schema));
    h5::write_attribute(file, "/", "schema_version", std::vector<std::int64_t>{1, 0});
    write_provenance(file, provenance);
    file.close();
}

void TimeSeries::add_table(const SeriesTable& table)
{
    h5::File file = h5::File::append(path_);
    if (!h5::holds(file, table.group))
    {
        h5::create_group(file, table.group);
        for (const Column& column : table.columns)
        {
            const std::string name = table.group + "/" + column.name;
            h5::create_growing(file, name, column.width);
            h5::write_attribute(file, name, "units", column.unit);
        }
    }
    file.close();
    tables_[table.group] = {table.columns, std::vector<std::vector<double>>(table.columns.size())};
}

void TimeSeries::append(const std::string& group, const std::vector<double>& values)
{
    Table&    table = tables_.at(group);
    const int width = std::accumulate(table.columns.begin(), table.columns.end(), 0,
                                      [](int sum, const Column& column) { return sum + column.width; });
    if (values.size() != static_cast<std::size_t>(width))
    {
        throw std::logic_error(fmt::format("{}: a row of {} values for {}", group, values.size(), width));
    }
    auto from = values.begin();
    for (std::size_t c = 0; c < table.columns.size(); ++c)
    {
        const auto to = from + table.columns[c].width;
        table.waiting[c].insert(table.waiting[c].end(), from, to);
        from = to;
    }
}

void TimeSeries::flush()
{
    h5::File file = h5::File::append(path_);
    for (auto& [group, table] : tables_)
    {
        for (std::size_t c = 0; c < table.columns.size(); ++c)
        {
            const Column& column = table.columns[c];
            h5::append_rows(file, group + "/" + column.name, table.waiting[c], column.width);
            table.waiting[c].clear();
        }
    }
    stamp_written(file);
    file.close();
}

} // namespace tread::io
