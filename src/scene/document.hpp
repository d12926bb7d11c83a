#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

// A TOML document as a tree in which every value knows its location in the file.
namespace tread::scene
{

/// Location of a value: "scene.toml:12" or "--set grid.spacing=0.02".
struct Location
{
    std::string  text;
    std::int64_t order = 0; ///< order in which problems are reported: lines of the file, then --set arguments
};

struct Node;
using NodeArray = std::vector<Node>;
using NodeTable = std::map<std::string, Node>;

/// A TOML value that no key accepts, such as a date or a number too large to represent.
struct OtherValue
{
    std::string kind;
};

struct Node
{
    std::variant<OtherValue, bool, std::int64_t, double, std::string, NodeArray, NodeTable> value;
    Location                                                                                where;
};

/// Name of a node's type for messages: "an integer", "a string" ...
std::string kind_of(const Node& node);

/// Member `key` of a table; nullptr if `node` is not a table or has no such member.
const Node* find(const Node& node, const std::string& key);

/// Parses a TOML file and returns its root table. InputError, with file and line, if it cannot be read, is malformed or
/// exceeds the limits of text_limits.hpp.
Node parse_document(const std::string& path);

/// The same of a text; `name` stands in messages for the file.
Node parse_document_text(const std::string& text, const std::string& name);

/// Parses one TOML value from a text within the limits of text_limits.hpp; text that is not TOML is taken as a bare
/// word, that is a string.
Node parse_value(const std::string& text, const Location& where);

} // namespace tread::scene
