#pragma once

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// Measured triaxial tests of configs/validation/data, and what the law answers to them.
namespace tread::test
{

/// Results of a drained triaxial compression test; compression is positive, NaN stands for what is not known.
struct TriaxialAnswer
{
    double peak_angle;    ///< degrees, asin((s1 - s3)/(s1 + s3)) at the largest s1/s3
    double peak_strain;   ///< %, axial, at the largest s1/s3
    double strain_at_3;   ///< %, axial, where s1/s3 = 3
    double dilation_rate; ///< largest -d eps_v/d eps_1
    double end_volume;    ///< %, volume strain at the end
    double end_angle;     ///< degrees, at the end
};

struct TriaxialColumn
{
    const char* name;
    double TriaxialAnswer::*value;
};

inline constexpr std::array<TriaxialColumn, 6> triaxial_columns = {{
    {"peak_angle [deg]", &TriaxialAnswer::peak_angle},
    {"peak_strain [%]", &TriaxialAnswer::peak_strain},
    {"strain_at_3 [%]", &TriaxialAnswer::strain_at_3},
    {"dilation_rate [1]", &TriaxialAnswer::dilation_rate},
    {"end_volume [%]", &TriaxialAnswer::end_volume},
    {"end_angle [deg]", &TriaxialAnswer::end_angle},
}};

struct Sand
{
    double void_ratio_min, void_ratio_max;
    double critical_angle; ///< degrees
};

struct TriaxialTest
{
    std::string    sand, name;
    double         void_ratio;
    double         cell_pressure; ///< kPa
    double         end_strain;    ///< %, axial
    TriaxialAnswer answer;
};

using CsvRow = std::map<std::string, std::string>;

/// Reads the rows of a file with a line of names after comments (#).
inline std::vector<CsvRow> read_csv(const std::string& path)
{
    std::ifstream file(path);
    if (!file) { throw std::runtime_error(path + ": cannot be read"); }
    std::vector<CsvRow>      rows;
    std::vector<std::string> names;
    for (std::string line; std::getline(file, line);)
    {
        if (line.starts_with('#')) { continue; }
        std::istringstream       stream(line + ",");
        std::vector<std::string> cells;
        for (std::string cell; std::getline(stream, cell, ',');) { cells.push_back(cell); }
        if (names.empty())
        {
            names = cells;
            continue;
        }
        if (cells.size() != names.size()) { throw std::runtime_error(path + ": other columns in: " + line); }
        for (CsvRow& row = rows.emplace_back(); const std::string& name : names)
        {
            row[name] = cells[static_cast<std::size_t>(&name - names.data())];
        }
    }
    return rows;
}

inline double number(const CsvRow& row, const std::string& column)
{
    const std::string& text = row.at(column);
    return text.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(text);
}

inline TriaxialAnswer triaxial_answer(const CsvRow& row)
{
    TriaxialAnswer answer{};
    for (const TriaxialColumn& column : triaxial_columns) { answer.*column.value = number(row, column.name); }
    return answer;
}

inline std::map<std::string, Sand> triaxial_sands(const std::string& path)
{
    std::map<std::string, Sand> sands;
    for (const CsvRow& row : read_csv(path))
    {
        sands[row.at("sand")] = {number(row, "void_ratio_min [1]"), number(row, "void_ratio_max [1]"),
                                 number(row, "critical_angle [deg]")};
    }
    return sands;
}

inline std::vector<TriaxialTest> triaxial_tests(const std::string& path)
{
    std::vector<TriaxialTest> tests;
    for (const CsvRow& row : read_csv(path))
    {
        tests.push_back({row.at("sand"), row.at("test"), number(row, "void_ratio [1]"),
                         number(row, "cell_pressure [kPa]"), number(row, "end_strain [%]"), triaxial_answer(row)});
    }
    return tests;
}

} // namespace tread::test
