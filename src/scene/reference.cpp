#include "scene/reference.hpp"

#include <type_traits>

#include "scene/keys.hpp"

namespace tread::scene
{
namespace
{

constexpr const char* introduction = R"(# Scene files

A scene is a TOML file; `tread check SCENE.toml` reads and checks it, `tread run SCENE.toml` runs it. This page is generated from
the table that reads scenes (src/scene/keys.cpp); `TREAD_REGENERATE_DOCS=1 unit_scene` writes it anew.

Units are SI; angles are in degrees, and their keys say so. Where a number is expected an integer does too. Unknown keys are
errors. All errors of a scene are reported at once, each as `file:line: [table] key: what; accepted: range`; at most 100.

Ranges are wider than what sand, rock and wheels have, so that no count made of the numbers leaves what a computer can hold. The text
itself may have 1 MiB, 32 KiB a line, 32 brackets in each other and 32 segments in a dotted key: the parser calls itself for each level,
and its time grows as the square of a line's length. A scene has at most 100 [[material]], 100 [[joint]], 10,000 [[contact]]
and 1000 of each other list of tables. What a scene makes (points, rocks, distance fields, maps of the surface, files that it reads) is estimated before it is made, and
refused, with exit code 4 and both figures, where it is more than the memory that the machine, a control group or `ulimit -v` leaves.

`--set table.key=value` sets a key as if the file said so: `--set domain.gravity=[0,0,-9.8]`, `--set material.sand.young=1e6`,
`--set phase.drive.drive.slip=0.3`. Arrays of tables go by name (`material.sand`) or index (`material[0]`, `terrain[0]`). The value
is TOML; a bare word is a string.

The run directory holds the resolved scene: every key explicit, every pair of contact families listed. It runs to the same result.
Pairs that the scene leaves out have friction 0.3 (0.5 with "wall") and restitution 0.5.
)";

/// Escapes the character that ends a table cell.
std::string cell(const std::string& text)
{
    std::string escaped;
    for (const char letter : text) { escaped += letter == '|' ? std::string("\\|") : std::string(1, letter); }
    return escaped;
}

std::string write_table(const TableText& table, const std::string& heading)
{
    std::string text = "\n" + heading + " " + table.title + "\n\n";
    if (!table.meaning.empty()) { text += table.meaning + "\n\n"; }
    text += "| key | unit | default | accepted | meaning |\n|---|---|---|---|---|\n";
    for (const auto& key : table.keys)
    {
        const auto condition = key.condition.empty() ? "" : " Only with `" + key.condition + "`.";
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, cell(key.unit), cell(key.fallback),
                            cell(key.accepted), cell(key.meaning + condition));
    }
    return text;
}

template<class T>
std::string write_tables(const std::string& title, const std::string& meaning, const Keys<T>& keys)
{
    std::string text = write_table(describe(title, meaning, keys), "##");
    for (const auto& key : keys)
    {
        for (auto inner : key.inner)
        {
            inner.title = "`" + inner.title + "`";
            text += write_table(inner, "###");
        }
    }
    return text;
}

template<class T>
std::string title_of(const std::string& table, T Scene::*)
{
    return "`[" + table + "]`";
}

template<class T>
std::string title_of(const std::string& table, std::vector<T> Scene::*)
{
    return "`[[" + table + "]]`";
}

} // namespace

std::string reference_markdown()
{
    std::string text = introduction + write_tables("Top level", "Before the first table.", scene_keys());
    for_each_table([&](const std::string& table, const char* meaning, auto member, const auto& keys)
                   { text += write_tables(title_of(table, member), meaning, keys); });
    return text;
}

} // namespace tread::scene
