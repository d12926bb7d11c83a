#include <algorithm>
#include <filesystem>
#include <functional>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/keys.hpp"
#include "scene/motion_tables.hpp"
#include "scene/named.hpp"
#include "scene/ranges.hpp"
#include "scene/support.hpp"
#include "scene/time_table.hpp"

// Checks of [[phase]] motion that need more than one key.
namespace tread::scene
{
namespace
{

bool is_held(const AxisMotion& axis) { return axis.kind == AxisKind::held || axis.kind == AxisKind::velocity; }

/// Whether a velocity is zero at all times.
bool stands_still(const AxisMotion& axis)
{
    if (axis.kind == AxisKind::held) { return true; }
    const Course& course = axis.course;
    const bool    turns  = course.table || course.value != 0 || course.ramp > 0;
    return axis.kind == AxisKind::velocity && !turns;
}

/// One motion of a phase, with its place in the document.
struct MotionCheck
{
    const Scene&  scene;
    const Phase&  phase;
    const Motion& motion;
    const Node&   node;
    std::string   label;
    Problems&     problems;

    void refuse(const std::string& key, std::string what, std::string accepted) const
    {
        const Node* value = find(node, key);
        problems.push_back(
            {(value != nullptr ? *value : node).where, label, key, std::move(what), std::move(accepted)});
    }

    const Body* body() const
    {
        const auto at = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                     [&](const Body& candidate) { return candidate.name == motion.body; });
        return at == scene.bodies.end() ? nullptr : &*at;
    }

    bool is_locked(const char* axis) const { return body() != nullptr && contains(body()->lock, axis); }
    bool stays(const AxisMotion& axis, const char* name) const { return is_held(axis) || is_locked(name); }
};

void check_body(const MotionCheck& check, std::size_t index)
{
    const Motion& motion = check.motion;
    const auto    bodies = names_in(check.scene.bodies);
    if (check.body() == nullptr && !contains(bodies, ""))
    {
        check.refuse("body",
                     fmt::format("there is no [[body]] called \"{}\"{}", motion.body, suggestion(motion.body, bodies)),
                     fmt::format("{}", fmt::join(bodies, ", ")));
    }
    for (std::size_t other = 0; other < index; ++other)
    {
        if (check.phase.motion[other].body != motion.body) { continue; }
        check.refuse("body", fmt::format("motion {} of this phase moves \"{}\" too", other, motion.body),
                     "one motion a body and phase");
    }
    const auto alone = [&](bool named, const char* key)
    {
        if (!named) { return; }
        check.refuse("body", fmt::format("`{}` of this phase names \"{}\" too", key, motion.body),
                     fmt::format("a body that `{}` does not name", key));
    };
    const Phase& phase = check.phase;
    alone(contains(phase.hold, motion.body), "hold");
    alone(phase.drive && phase.drive->body == motion.body, "drive");
    alone(phase.lower && phase.lower->body == motion.body, "lower");
    alone(phase.weight && phase.weight->body == motion.body, "weight");
}

/// A body's `lock` holds axes of the world.
void check_locks(const MotionCheck& check, const char* frame_key, MotionFrame frame,
                 const std::array<AxisMotion, 3>& axes, const std::array<const char*, 3>& axis_names)
{
    for (std::size_t c = 0; c < 3; ++c)
    {
        if (!check.is_locked(axis_names[c])) { continue; }
        if (frame == MotionFrame::body)
        {
            check.refuse(frame_key,
                         fmt::format("`lock` of \"{}\" holds {} in the world's axes", check.motion.body, axis_names[c]),
                         "\"world\", or a body without that lock and \"held\" here");
            return;
        }
        if (axes[c].kind == AxisKind::velocity || axes[c].kind == AxisKind::effort)
        {
            check.refuse(axis_names[c], fmt::format("`lock` of \"{}\" holds that axis", check.motion.body),
                         "\"held\", or a body without that lock");
        }
    }
}

void check_axle(const MotionCheck& check)
{
    const Motion& motion = check.motion;
    const bool    pitch  = motion.rotation[1].kind != AxisKind::free || check.is_locked("pitch");
    if (motion.axle.kind != AxisKind::free && pitch)
    {
        check.refuse("axle", "pitch is held or driven too, which is a rotation about the same axis",
                     "a free pitch, or axle = \"free\"");
    }
    if (motion.axle_friction > 0 && (is_held(motion.axle) || check.stays(motion.rotation[1], "pitch")))
    {
        check.refuse("axle_friction", "the rotation about the axle is held or prescribed: friction changes nothing",
                     "an axle and a pitch that are free or have a torque");
    }
}

void check_load(const MotionCheck& check)
{
    const bool stays = check.stays(check.motion.translation[2], "z");
    const auto felt  = [&](bool given, const char* key)
    {
        if (given && stays)
        {
            check.refuse(key, "z is held or prescribed: no load changes the motion", "z = \"free\" or a force");
        }
    };
    felt(check.motion.load.has_value(), "load");
    felt(check.motion.carriage.has_value(), "carriage");
}

void check_stops(const MotionCheck& check)
{
    const auto& stops = check.motion.until;
    if (!stops) { return; }
    if (*stops == MotionStop{})
    {
        check.refuse("until", "names no stop",
                     "force_x | force_y | force_z | displacement_x | displacement_y | "
                     "displacement_z");
    }
    if (check.phase.until != StopRule::duration)
    {
        check.refuse("until", "the phase has another `until`", "until = \"duration\" in the phase, its limit of time");
    }
    for (std::size_t c = 0; c < 3; ++c)
    {
        const AxisMotion& axis = check.motion.translation[c];
        if (!stops->displacement[c]) { continue; }
        if (!stands_still(axis) && !check.is_locked(translation_axes[c])) { continue; }
        check.refuse("until", fmt::format("displacement_{0} can never be reached: {0} is held", translation_axes[c]),
                     "a stop along an axis that moves");
    }
}

/// The first key of a motion that is a force or torque; null if none is.
const char* effort_key(const Motion& motion)
{
    const auto is_effort = [](const AxisMotion& axis) { return axis.kind == AxisKind::effort; };
    for (std::size_t c = 0; c < 3; ++c)
    {
        if (is_effort(motion.translation[c])) { return translation_axes[c]; }
        if (is_effort(motion.rotation[c])) { return rotation_axes[c]; }
    }
    if (is_effort(motion.axle)) { return "axle"; }
    return motion.load ? "load" : nullptr;
}

void check_support(const MotionCheck& check, std::size_t phase)
{
    const char* key = effort_key(check.motion);
    if (key == nullptr || check.body() == nullptr) { return; }
    const std::size_t body = index_of(check.scene.bodies, check.motion.body);
    if (has_support(check.scene, phase, body)) { return; }
    check.refuse(key, fmt::format("nothing takes up what acts on \"{}\"", check.motion.body),
                 "joints, or pairs that touch, from it to \"world\", a wall, [[terrain]], [[rocks]], or another body "
                 "that the phase holds or leads");
}

/// Calls visit(motion, node, label) for each motion of each phase that was read without a problem.
template<class Visit>
void for_each_motion(const Node& document, std::size_t phases, const Problems& problems, const Visit& visit)
{
    const Node* list  = find(document, "phase");
    const auto* items = list != nullptr ? std::get_if<NodeArray>(&list->value) : nullptr;
    for (std::size_t i = 0; items != nullptr && i < std::min(phases, items->size()); ++i)
    {
        const Node* motions = find((*items)[i], "motion");
        const auto* array   = motions != nullptr ? std::get_if<NodeArray>(&motions->value) : nullptr;
        for (std::size_t j = 0; array != nullptr && j < array->size(); ++j)
        {
            const std::string label = motion_label(table_label(document, "phase", i), j);
            if (!mentions_inside(problems, label)) { visit(i, j, (*array)[j], label); }
        }
    }
}

/// Reads the table of a course, if it has one.
void complete_course(Course& course, const std::string& directory, const Range& range, double end, const Node& node,
                     const std::string& label, Problems& problems)
{
    if (!course.table) { return; }
    course.table->path = (std::filesystem::path(directory) / course.table->path).lexically_normal().string();
    const auto fault   = read_time_table(*course.table, range, end);
    if (!fault) { return; }
    problems.push_back({node.where, label, fault->key,
                        fmt::format("{}:{}: {}", course.table->path, fault->line, fault->what), fault->accepted});
}

/// Calls visit(course, key, range) for each course that a motion may have.
template<class Visit>
void for_each_course(Motion& motion, const Visit& visit)
{
    const Range effort = between(-1e12, 1e12);
    for (std::size_t c = 0; c < 3; ++c)
    {
        const bool moves = motion.translation[c].kind == AxisKind::velocity;
        visit(motion.translation[c].course, translation_axes[c], moves ? velocity() : effort);
        const bool turns = motion.rotation[c].kind == AxisKind::velocity;
        visit(motion.rotation[c].course, rotation_axes[c], turns ? spin() : effort);
    }
    visit(motion.axle.course, "axle", motion.axle.kind == AxisKind::velocity ? spin() : effort);
    if (motion.load) { visit(*motion.load, "load", between(0, 1e12)); }
}

} // namespace

void complete_motions(Scene& scene, const Node& document, Problems& problems)
{
    for_each_motion(document, scene.phases.size(), problems,
                    [&](std::size_t i, std::size_t j, const Node& node, const std::string& label)
                    {
                        const double end = time_limit(scene.phases[i]);
                        for_each_course(scene.phases[i].motion[j],
                                        [&](Course& course, const std::string& key, const Range& range)
                                        {
                                            const Node* given = find(node, key);
                                            complete_course(course, scene.directory, range, end,
                                                            given != nullptr ? *given : node, label + "." + key,
                                                            problems);
                                        });
                    });
}

std::vector<NamedCourse> courses_of(const Motion& motion)
{
    std::vector<NamedCourse> courses;
    const auto               add = [&](const char* key, const AxisMotion& axis)
    {
        if (axis.kind == AxisKind::velocity || axis.kind == AxisKind::effort) { courses.push_back({key, axis.course}); }
    };
    for (std::size_t c = 0; c < 3; ++c) { add(translation_axes[c], motion.translation[c]); }
    for (std::size_t c = 0; c < 3; ++c) { add(rotation_axes[c], motion.rotation[c]); }
    add("axle", motion.axle);
    if (motion.load) { courses.push_back({"load", *motion.load}); }
    return courses;
}

void add_motion_files(const Scene& scene, const std::function<void(const std::string&, const std::string&)>& add)
{
    for (const Phase& phase : scene.phases)
    {
        for (const Motion& motion : phase.motion)
        {
            for (const auto& [key, course] : courses_of(motion))
            {
                if (!course.table) { continue; }
                add(course.table->path,
                    fmt::format("[[phase]] '{}' motion of '{}' {} table", phase.name, motion.body, key));
            }
        }
    }
}

void validate_motions(const Scene& scene, Checker& checker)
{
    for_each_motion(checker.document, scene.phases.size(), checker.problems,
                    [&](std::size_t i, std::size_t j, const Node& node, const std::string& label)
                    {
                        const Motion&     motion = scene.phases[i].motion[j];
                        const MotionCheck check{scene, scene.phases[i], motion, node, label, checker.problems};
                        check_body(check, j);
                        check_locks(check, "frame", motion.frame, motion.translation, translation_axes);
                        check_locks(check, "rotation_frame", motion.rotation_frame, motion.rotation, rotation_axes);
                        check_axle(check);
                        check_load(check);
                        check_stops(check);
                        check_support(check, i);
                    });
}

} // namespace tread::scene
