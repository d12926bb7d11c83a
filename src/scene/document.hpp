#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

// A TOML document as a tree whose every value knows where it was written.
namespace tread::scene
{

/// Where a value was written: "scene.toml:12" or "--set grid.spacing=0.02".
struct Location
{
    std::string  text;
    std::int64_t order = 0; ///< problems are reported in this order: lines of the file, then --set arguments
};

struct Node;
using NodeArray = std::vector<Node>;
using NodeTable = std::map<std::string, Node>;

/// What no key of a scene accepts: a date, a number too large to hold.
struct OtherValue
{
    std::string kind;
};

struct Node
{
    std::variant<OtherValue, bool, std::int64_t, double, std::string, NodeArray, NodeTable> value;
    Location                                                                                where;
};

/// "an integer", "a string" ..., for messages.
std::string kind_of(const Node& node);

/// The member `key` of a table; nullptr if `node` is no table or has no such member.
const Node* find(const Node& node, const std::string& key);

/// The root table of a TOML file. InputError, with file and line, if it cannot be read, is malformed or is beyond the
/// limits of text_limits.hpp.
Node parse_document(const std::string& path);

/// One TOML value of a text within the limits of text_limits.hpp; what is not TOML is taken as a bare word, that is a
/// string.
Node parse_value(const std::string& text, const Location& where);

} // namespace tread::scene
