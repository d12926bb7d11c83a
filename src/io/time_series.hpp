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

/// A group of data sets, one a column.
struct SeriesTable
{
    std::string         group; ///< "/wheel/front"
    std::vector<Column> columns;
};

enum class SeriesFile
{
    anew,
    continued ///< as it is; rows follow those that are there
};

/// EnvironmentError unless a file, which came within a checkpoint, is a time series in which these tables can be
/// continued, as far as it has them. Its contents would else be whatever other file it names.
void require_series(const std::string& path, const std::vector<SeriesTable>& tables, const std::string& checkpoint);

/// timeseries.h5: a data set for every column of every table, one row a time. Of one process. The file is closed
/// between flushes, so that it can be read while the run goes on. EnvironmentError when it cannot be written.
class TimeSeries
{
public:
    explicit TimeSeries(std::string path, const Provenance& provenance = {}, SeriesFile file = SeriesFile::anew);

    /// Groups above its group are made. What a continued file has, stays.
    void add_table(const SeriesTable& table);

    /// One row: the values of all columns, one column after the other. Kept in memory until flush().
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
