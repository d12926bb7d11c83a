#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/provenance.hpp"

namespace tread::io
{

struct Column
{
    std::string name;
    int         width; ///< values a row: 1, or 3 for a vector
    std::string unit;  ///< "m/s"; "1" if it has none
};

/// A group of data sets, one per column.
struct SeriesTable
{
    std::string         group; ///< "/wheel/front"
    std::vector<Column> columns;
};

enum class SeriesFile
{
    anew,
    continued ///< kept; new rows follow the present ones
};

/// EnvironmentError unless a file restored from a checkpoint is a time series that these tables can continue. Otherwise
/// it could draw its contents from any other file that it names.
void require_series(const std::string& path, const std::vector<SeriesTable>& tables, const std::string& checkpoint);

/// Writes timeseries.h5: a data set for every column of every table, one row per time. Used by one process. The file is
/// closed between flushes, so that it can be read during the run. EnvironmentError if it cannot be written.
class TimeSeries
{
public:
    explicit TimeSeries(std::string path, const Provenance& provenance = {}, SeriesFile file = SeriesFile::anew);

    /// Creates the table and its parent groups; data in a continued file stay.
    void add_table(const SeriesTable& table);

    /// Appends a row: the values of all columns, one column after the other. Kept in memory until flush().
    void append(const std::string& group, const std::vector<double>& values);

    void flush();

private:
    struct Table
    {
        std::vector<Column>              columns;
        std::vector<std::vector<double>> waiting; ///< of each column, row-major
    };

    std::string                  path_;
    std::map<std::string, Table> tables_;
};

} // namespace tread::io
