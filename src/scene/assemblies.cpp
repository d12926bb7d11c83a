#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/keys.hpp"
#include "scene/named.hpp"

// Checks of assemblies: their parts exist, none contains itself, and all together are few enough to be made.
namespace tread::scene
{
namespace
{

constexpr std::int64_t most_parts = 1000; ///< of an assembly, when its parts are taken apart down to the last

const Assembly* assembly_of(const Scene& scene, std::size_t shape)
{
    return std::get_if<Assembly>(&scene.shapes[shape].source);
}

/// Reports a problem at the name of a part.
void report_part(std::size_t shape, std::size_t part, const std::string& what, const std::string& accepted,
                 Checker& checker)
{
    const TableAt at{"shape", shape};
    const Node*   name = find(std::get<NodeArray>(checker.given(at, "assemble")->value)[part], "shape");
    checker.problems.push_back(
        {name->where, fmt::format("{}.assemble.{}", checker.label(at), part), "shape", what, accepted});
}

void require_known_parts(const Scene& scene, std::size_t shape, Checker& checker)
{
    std::vector<std::string> known = names_in(scene.shapes);
    known.insert(known.end(), builtin_wheels.begin(), builtin_wheels.end());
    const auto& parts = assembly_of(scene, shape)->parts;
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
        if (std::find(known.begin(), known.end(), parts[p].shape) != known.end()) { continue; }
        report_part(shape, p,
                    fmt::format("there is no shape called \"{}\"{}", parts[p].shape, suggestion(parts[p].shape, known)),
                    fmt::format("{}", fmt::join(known, ", ")), checker);
    }
}

/// Depth-first walk through parts of parts.
struct PartWalk
{
    enum class State
    {
        unseen,
        open, ///< on the path from the assembly where the walk began
        done
    };

    const Scene&              scene;
    Checker&                  checker;
    std::vector<State>        states;
    std::vector<std::int64_t> counts; ///< of parts, taken apart; at most most_parts + 1

    /// Visits a shape; reports the first part that closes a cycle. Returns whether there is none.
    bool visit(std::size_t shape)
    {
        const Assembly* assembly = assembly_of(scene, shape);
        states[shape]            = State::open;
        counts[shape]            = assembly == nullptr ? 1 : 0;
        for (std::size_t p = 0; assembly != nullptr && p < assembly->parts.size(); ++p)
        {
            const std::string& name = assembly->parts[p].shape;
            const std::size_t  part = index_of(scene.shapes, name);
            const bool         made = part < scene.shapes.size(); // else it is built in
            if (made && states[part] == State::open)
            {
                report_part(shape, p, fmt::format("\"{}\" would contain itself", name),
                            "a shape without this one in it", checker);
                return false;
            }
            if (made && states[part] == State::unseen && !visit(part)) { return false; }
            counts[shape] = std::min(counts[shape] + (made ? counts[part] : 1), most_parts + 1);
        }
        states[shape] = State::done;
        return true;
    }
};

} // namespace

void validate_assemblies(const Scene& scene, Checker& checker)
{
    bool sound = true;
    for (std::size_t s = 0; s < scene.shapes.size(); ++s)
    {
        if (assembly_of(scene, s) == nullptr) { continue; }
        if (!checker.sound({"shape", s}, {"name", "assemble"}))
        {
            sound = false;
            continue;
        }
        const std::size_t before = checker.problems.size();
        require_known_parts(scene, s, checker);
        sound = sound && checker.problems.size() == before;
    }
    if (!sound) { return; }
    PartWalk walk{scene, checker, std::vector<PartWalk::State>(scene.shapes.size(), PartWalk::State::unseen),
                  std::vector<std::int64_t>(scene.shapes.size(), 0)};
    for (std::size_t s = 0; s < scene.shapes.size(); ++s)
    {
        if (walk.states[s] == PartWalk::State::unseen && !walk.visit(s)) { return; }
        if (walk.counts[s] > most_parts)
        {
            checker.report({"shape", s}, "assemble", "its parts are over 1000 when taken apart",
                           fmt::format("at most {} parts", most_parts));
            return;
        }
    }
}

} // namespace tread::scene
