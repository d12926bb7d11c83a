#include "scene/differences.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

namespace tread::scene
{
namespace
{

using Place = std::tuple<std::string, std::size_t, std::string>; ///< table, index, key

/// Whether a line belongs to the value of the key before it: an array with an element a line.
bool continues(const std::string& line) { return line.rfind("  ", 0) == 0 || line.rfind(']', 0) == 0; }

/// Splits a resolved scene: one key per line, in tables that start with a line in brackets.
std::map<Place, std::string> keys_of(const std::string& resolved)
{
    std::map<Place, std::string>       keys;
    std::map<std::string, std::size_t> seen;
    std::istringstream                 lines(resolved);
    std::string                        line, table;
    std::size_t                        index = 0;
    std::string*                       last  = nullptr; // the value of the key before
    while (std::getline(lines, line))
    {
        const std::size_t equals = line.find(" = ");
        if (last != nullptr && continues(line)) { *last += line; }
        else if (!line.empty() && line.front() == '[')
        {
            table = line.substr(line.find_first_not_of('['), line.find(']') - line.find_first_not_of('['));
            index = seen[table]++;
        }
        else if (equals != std::string::npos)
        {
            last  = &keys[{table, index, line.substr(0, equals)}];
            *last = line.substr(equals + 3);
        }
    }
    return keys;
}

bool is_array(const std::string& table)
{
    for (const char* array : {"material", "contact", "shape", "terrain", "rocks", "body", "joint", "phase"})
    {
        if (table == array) { return true; }
    }
    return false;
}

} // namespace

std::vector<Difference> differences(const std::string& before, const std::string& after)
{
    const auto              was = keys_of(before), is = keys_of(after);
    std::vector<Difference> found;
    const auto              add = [&](const Place& place, const std::string& old, const std::string& now) {
        found.push_back({std::get<0>(place), std::get<1>(place), std::get<2>(place), old, now});
    };
    for (const auto& [place, value] : was)
    {
        const auto at = is.find(place);
        if (at == is.end()) { add(place, value, ""); }
        else if (at->second != value) { add(place, value, at->second); }
    }
    for (const auto& [place, value] : is)
    {
        if (was.count(place) == 0) { add(place, "", value); }
    }
    return found;
}

std::string place_of(const Difference& difference)
{
    const std::string table = difference.table.empty() ? ""
                              : is_array(difference.table)
                                  ? fmt::format("[[{}]] {} ", difference.table, difference.index)
                                  : fmt::format("[{}] ", difference.table);
    return table + difference.key;
}

std::string describe(const Difference& difference)
{
    const auto shown = [](const std::string& value) { return value.empty() ? "not given" : value; };
    return fmt::format("{}: {}, was {}", place_of(difference), shown(difference.is), shown(difference.was));
}

bool may_change(const Difference& difference, std::size_t phase)
{
    const std::string &table = difference.table, &key = difference.key;
    if (table.empty()) { return key == "title"; }
    if (table == "output") { return key == "every" || key == "snapshots_every"; }
    if (table == "checkpoint" || table == "balance" || table == "reference") { return true; }
    const bool given_both = !difference.was.empty() && !difference.is.empty();
    if (table == "sleep") { return given_both && phase != no_phase_to_come; }
    return table == "phase" && difference.index >= phase && given_both && (key == "duration" || key == "max_duration");
}

} // namespace tread::scene
