#include "scene/problems.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread::scene
{
namespace
{

/// Levenshtein's distance: the least number of letters inserted, deleted or replaced.
std::size_t edit_distance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        std::size_t diagonal = row[0];
        row[0]               = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j)
        {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal                   = row[j + 1];
            row[j + 1]                 = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string to_string(const Problem& problem)
{
    std::string text = problem.where.text + ":";
    if (!problem.table.empty()) { text += " [" + problem.table + "]"; }
    if (!problem.key.empty()) { text += " " + problem.key; }
    if (!problem.table.empty() || !problem.key.empty()) { text += ":"; }
    text += " " + problem.what;
    if (!problem.accepted.empty()) { text += "; accepted: " + problem.accepted; }
    return text;
}

bool mentions(const Problems& problems, const std::string& table, const std::string& key)
{
    return std::any_of(problems.begin(), problems.end(),
                       [&](const Problem& problem) { return problem.table == table && problem.key == key; });
}

bool mentions_inside(const Problems& problems, const std::string& table)
{
    return std::any_of(problems.begin(), problems.end(),
                       [&](const Problem& problem)
                       { return problem.table == table || problem.table.rfind(table + ".", 0) == 0; });
}

void throw_if_any(Problems problems)
{
    if (problems.empty()) { return; }
    std::stable_sort(problems.begin(), problems.end(),
                     [](const Problem& a, const Problem& b) { return a.where.order < b.where.order; });
    std::vector<std::string> lines;
    for (const auto& problem : problems) { lines.push_back(to_string(problem)); }
    throw InputError(fmt::format("{}", fmt::join(lines, "\n")));
}

std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates)
{
    const auto        best    = std::min_element(candidates.begin(), candidates.end(),
                                                 [&](const std::string& a, const std::string& b)
                                                 { return edit_distance(word, a) < edit_distance(word, b); });
    const std::size_t allowed = (word.size() + 2) / 3;
    if (best == candidates.end() || edit_distance(word, *best) > allowed) { return std::nullopt; }
    return *best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates)
{
    const auto near = nearest(word, candidates);
    return near ? fmt::format("; did you mean \"{}\"?", *near) : std::string();
}

} // namespace tread::scene
