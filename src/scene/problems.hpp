#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/document.hpp"

namespace tread::scene
{

/// One thing wrong with a scene.
struct Problem
{
    Location    where;
    std::string table; ///< "material.sand"; empty at the top level
    std::string key;   ///< empty if the table itself is meant
    std::string what;
    std::string accepted; ///< range or words; empty if `what` says it all
};

using Problems = std::vector<Problem>;

/// `file:line: [table] key: what; accepted: range`
std::string to_string(const Problem& problem);

/// Whether a problem with this key was found already: what follows from it is not worth a second message.
bool mentions(const Problems& problems, const std::string& table, const std::string& key);

/// Whether a problem was found in this inner table or deeper.
bool mentions_inside(const Problems& problems, const std::string& table);

/// Problems that one message names.
inline constexpr std::size_t most_problems = 100;

/// InputError with the first `most_problems` problems, one a line in the order of the file; returns if there is none.
void throw_if_any(Problems problems);

/// The candidate nearest to a misspelt word by edit distance, whether letters are large or small; nothing if none is
/// near.
std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates);

/// "; did you mean "sand"?", or nothing if no candidate is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

} // namespace tread::scene
