#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/document.hpp"

namespace tread::scene
{

/// One problem of a scene.
struct Problem
{
    Location    where;
    std::string table; ///< "material.sand"; empty at the top level
    std::string key;   ///< empty if the problem concerns the table itself
    std::string what;
    std::string accepted; ///< range or words; empty if `what` says it all
};

using Problems = std::vector<Problem>;

/// Formats a problem as `file:line: [table] key: what; accepted: range`.
std::string to_string(const Problem& problem);

/// Whether a problem with this key was already found, so that problems caused by it need no message of their own.
bool mentions(const Problems& problems, const std::string& table, const std::string& key);

/// Whether a problem was found in this inner table, in one of an array of that name, or deeper.
bool mentions_inside(const Problems& problems, const std::string& table);

/// Largest number of problems in one message.
inline constexpr std::size_t most_problems = 100;

/// InputError with the first `most_problems` problems, one per line in the order of the file; returns if there is none.
void throw_if_any(Problems problems);

/// Candidate nearest to a misspelt word by edit distance, ignoring case; empty if none is near.
std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates);

/// Suggestion for a message, "; did you mean "sand"?"; empty if no candidate is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

} // namespace tread::scene
