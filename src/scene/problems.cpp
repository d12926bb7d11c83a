#include "scene/problems.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "scene/text.hpp"

namespace tread::scene
{
namespace
{

/// Levenshtein distance: smallest number of letters inserted, deleted or replaced.
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

std::string lower(std::string text)
{
    for (char& letter : text)
    {
        if (letter >= 'A' && letter <= 'Z') { letter = static_cast<char>(letter - 'A' + 'a'); }
    }
    return text;
}

} // namespace

std::string to_string(const Problem& problem)
{
    constexpr std::size_t most_text = 500; // bytes of a message's text, which may contain a user's names and words
    std::string           text      = problem.where.text + ":";
    if (!problem.table.empty()) { text += fmt::format(" [{}]", shown(problem.table)); }
    if (!problem.key.empty()) { text += fmt::format(" {}", shown(problem.key)); }
    if (!problem.table.empty() || !problem.key.empty()) { text += ":"; }
    text += fmt::format(" {}", shown(problem.what, most_text));
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
                       {
                           const std::string& label = problem.table;
                           return label == table || label.rfind(table + ".", 0) == 0 ||
                                  label.rfind(table + "[", 0) == 0;
                       });
}

void throw_if_any(Problems problems)
{
    if (problems.empty()) { return; }
    std::stable_sort(problems.begin(), problems.end(),
                     [](const Problem& a, const Problem& b) { return a.where.order < b.where.order; });
    std::vector<std::string> lines;
    const std::size_t        named = std::min(problems.size(), most_problems);
    for (std::size_t i = 0; i < named; ++i) { lines.push_back(to_string(problems[i])); }
    if (named < problems.size()) { lines.push_back(fmt::format("and {} errors more", problems.size() - named)); }
    throw InputError(fmt::format("{}", fmt::join(lines, "\n")));
}

std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates)
{
    constexpr std::size_t longest = 100;
    if (word.empty() || word.size() > longest) { return std::nullopt; }
    const std::string          typed   = lower(word);
    std::size_t                allowed = std::min((word.size() + 2) / 3, word.size() - 1);
    std::optional<std::string> best;
    for (const std::string& candidate : candidates)
    {
        const std::size_t away = edit_distance(typed, lower(candidate));
        if (candidate.empty() || away > allowed || (best && away == allowed)) { continue; }
        allowed = away;
        best    = candidate;
    }
    return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates)
{
    const auto near = nearest(word, candidates);
    return near ? fmt::format("; did you mean \"{}\"?", *near) : std::string();
}

} // namespace tread::scene
