#include "scene/keys.hpp"
#include "scene/ranges.hpp"

// Keys of [[phase]] motion.
template<>
inline constexpr auto tread::scene::spellings<tread::scene::MotionFrame> =
    tread::scene::spell<tread::scene::MotionFrame>({{tread::scene::MotionFrame::world, "world"},
                                                    {tread::scene::MotionFrame::body, "body"}});

namespace tread::scene
{
namespace
{

enum class AxisSort
{
    translation,
    rotation
};

const char* effort_name(AxisSort sort) { return sort == AxisSort::translation ? "force" : "torque"; }
Range       velocity_range(AxisSort sort) { return sort == AxisSort::translation ? velocity() : spin(); }
Range       effort_range() { return between(-1e12, 1e12); }

Keys<TimeTable> table_keys()
{
    return {
        required("table", "", &TimeTable::path, path(),
                 "A CSV of numbers: a first line of column names, of which one is `time` (s since the phase began, "
                 "increasing, from 0 or before to the end of the phase or later). Linear between rows. A relative path "
                 "starts at the scene file."),
        required("column", "", &TimeTable::column, name(), "The column with the values."),
    };
}

/// A value, or a table of it.
struct Quantity
{
    double                   value = 0;
    std::optional<TimeTable> table;
};

void read_quantity(const Node& node, const std::string& table, const std::string& key, const Range& range,
                   Quantity& quantity, Problems& problems)
{
    if (std::holds_alternative<NodeTable>(node.value))
    {
        TimeTable read;
        read_table(node, table + "." + key, table_keys(), read, problems);
        quantity.table = read;
        return;
    }
    try
    {
        quantity.value = read_number(node, range);
    }
    catch (const BadValue& bad)
    {
        problems.push_back(
            {node.where, table, key, bad.what, range.text() + ", or { table = \"FILE.csv\", column = \"NAME\" }"});
    }
}

std::string write_quantity(const Course& course)
{
    return course.table ? write_inline(table_keys(), *course.table) : write_number(course.value);
}

/// Reads `{ <word> = value, ramp, from }` or `{ <word> = { table, column } }`.
struct CourseReader
{
    std::string word;
    std::string unit;
    Range       range;

    std::string accepted() const
    {
        return fmt::format("{{ {0} = {1} ({2}), ramp = seconds, from = {2} }} or {{ {0} = {{ table, column }} }}", word,
                           range.text(), unit);
    }

    void operator()(const Node& node, const std::string& table, Course& course, Problems& problems) const
    {
        check_unknown(node, table, {word, "ramp", "from"}, problems);
        Quantity quantity;
        read_quantity(*find(node, word), table, word, range, quantity, problems);
        course.value = quantity.value;
        course.table = quantity.table;
        for (const char* key : {"ramp", "from"})
        {
            const Node* given = find(node, key);
            if (given == nullptr) { continue; }
            if (course.table) { problems.push_back({given->where, table, key, "may stand only without a table", ""}); }
            const Range allowed = key == std::string("ramp") ? time_or_none() : range;
            try
            {
                const double value = read_number(*given, allowed);
                if (key == std::string("ramp")) { course.ramp = value; }
                else { course.from = value; }
            }
            catch (const BadValue& bad)
            {
                problems.push_back({given->where, table, key, bad.what, allowed.text()});
            }
        }
        if (course.from && course.ramp == 0)
        {
            problems.push_back({node.where, table, "from", "may stand only with a ramp", "ramp > 0 (s)"});
        }
    }

    std::string write(const Course& course) const
    {
        std::string text = fmt::format("{{ {} = {}", word, write_quantity(course));
        if (!course.table) { text += fmt::format(", ramp = {}", write_number(course.ramp)); }
        if (course.from) { text += fmt::format(", from = {}", write_number(*course.from)); }
        return text + " }";
    }
};

CourseReader velocity_reader(AxisSort sort)
{
    return {"velocity", sort == AxisSort::translation ? "m/s" : "rad/s", velocity_range(sort)};
}

CourseReader effort_reader(AxisSort sort)
{
    return {effort_name(sort), sort == AxisSort::translation ? "N" : "N m", effort_range()};
}

std::string accepted_axis(AxisSort sort)
{
    return fmt::format("\"free\" | \"held\" | {{ velocity = ... }} | {{ {} = ... }}, see [[phase]] motion x",
                       effort_name(sort));
}

void read_axis(const Node& node, const std::string& table, const std::string& key, AxisSort sort, AxisMotion& axis,
               Problems& problems)
{
    const auto refuse = [&](const std::string& what) {
        problems.push_back({node.where, table, key, what, accepted_axis(sort)});
    };
    if (const auto* text = std::get_if<std::string>(&node.value))
    {
        if (*text == "held") { axis.kind = AxisKind::held; }
        else if (*text != "free") { refuse(fmt::format("unknown word \"{}\"", *text)); }
        return;
    }
    if (!std::holds_alternative<NodeTable>(node.value)) { return refuse("wrong type: " + kind_of(node)); }
    const bool velocity = find(node, "velocity") != nullptr, effort = find(node, effort_name(sort)) != nullptr;
    if (velocity == effort)
    {
        return refuse(fmt::format("{} of velocity, {}", velocity ? "both" : "neither", effort_name(sort)));
    }
    axis.kind = velocity ? AxisKind::velocity : AxisKind::effort;
    (velocity ? velocity_reader(sort) : effort_reader(sort))(node, table + "." + key, axis.course, problems);
}

std::string write_axis(const AxisMotion& axis, AxisSort sort)
{
    switch (axis.kind)
    {
    case AxisKind::free:
        return write_string("free");
    case AxisKind::held:
        return write_string("held");
    case AxisKind::velocity:
        return velocity_reader(sort).write(axis.course);
    case AxisKind::effort:
        break;
    }
    return effort_reader(sort).write(axis.course);
}

/// `access`: function from Motion& to the AxisMotion.
template<class Access>
Key<Motion> axis_key(const std::string& name, AxisSort sort, Access access, const std::string& meaning)
{
    const KeyText text{name, "", "\"free\"", accepted_axis(sort), meaning, ""};
    auto          read = [=](const Node& node, const std::string& table, Motion& motion, Problems& problems)
    { read_axis(node, table, name, sort, access(motion), problems); };
    auto write = [=](const Motion& motion) { return write_axis(access(motion), sort); };
    return {text, Presence::optional, [](const Motion&) { return true; }, read, write, {}};
}

Key<Motion> translation_key(std::size_t axis, const std::string& meaning)
{
    return axis_key(
        translation_axes[axis],
        AxisSort::translation, [axis](auto& motion) -> auto& { return motion.translation[axis]; }, meaning);
}

Key<Motion> rotation_key(std::size_t axis, const std::string& meaning)
{
    return axis_key(
        rotation_axes[axis], AxisSort::rotation, [axis](auto& motion) -> auto& { return motion.rotation[axis]; },
        meaning);
}

/// Keys of a course, for docs/scene.md only.
std::vector<TableText> describe_course()
{
    TableText         course{"[[phase]] motion x",
                     "The value of x, y, z, roll, pitch, yaw and axle, if it is a table; with "
                             "`torque` and rad/s for rotations.",
                     {}};
    const std::string value = "number, or { table, column }";
    const auto        add   = [&](const char* key, const char* unit, const char* fallback, std::string accepted,
                         const char* meaning, const char* condition) {
        course.keys.push_back({key, unit, fallback, std::move(accepted), meaning, condition});
    };
    add("velocity", "m/s", "or `force`", value, "Velocity along the axis, whatever the forces.", "");
    add("force", "N", "or `velocity`", value, "Force along the axis, besides contact and gravity.", "");
    add("ramp", "s", "0.0", time_or_none().text(), "Time over which the value is reached linearly.", "a number");
    add("from", "", "the velocity when the phase begins; no force", "number", "Value at the start of the ramp.",
        "ramp");
    return {course, describe("[[phase]] motion x velocity", "", table_keys())};
}

Key<Motion> load_key()
{
    const CourseReader reader{"force", "N", between(0, 1e12)};
    const KeyText      text{"load",
                       "N",
                       "the weight acts",
                       between(0, 1e12).text() + ", or " + reader.accepted(),
                       "A dead weight: what pulls the body down in place of its weight, along gravity, or along -z "
                            "without gravity. Its mass stays.",
                       ""};
    auto               read = [=](const Node& node, const std::string& table, Motion& motion, Problems& problems)
    {
        Course& course = motion.load.emplace();
        if (std::holds_alternative<NodeTable>(node.value) && find(node, "force") != nullptr)
        {
            reader(node, table + ".load", course, problems);
            return;
        }
        try
        {
            course.value = read_number(node, reader.range);
        }
        catch (const BadValue& bad)
        {
            problems.push_back({node.where, table, "load", bad.what, text.accepted});
        }
    };
    auto write = [=](const Motion& motion) { return motion.load ? reader.write(*motion.load) : std::string(); };
    return {text, Presence::optional, [](const Motion&) { return true; }, read, write, {}};
}

Keys<Carriage> carriage_keys()
{
    return {
        required("stiffness", "N/m", &Carriage::stiffness, number(above_up_to(0, 1e12)), "Of the spring."),
        optional("damping", "N s/m", &Carriage::damping, number(between(0, 1e12)), "Of the damper beside it."),
        required("height", "m", &Carriage::height, number(coordinate()),
                 "z of the body's centre of mass at which the spring is at rest."),
    };
}

template<std::size_t axis>
Key<MotionStop> force_stop()
{
    auto key = make_key<MotionStop>(
        Presence::optional, {fmt::format("force_{}", translation_axes[axis]), "N", "none", {}, "", ""},
        [](auto& stop) -> auto& { return stop.force[axis]; }, number_or("", above_up_to(0, 1e12)));
    key.text.meaning = "Contact force along that axis of the frame, in either direction, as a mean over 10 ms.";
    return key;
}

template<std::size_t axis>
Key<MotionStop> displacement_stop()
{
    auto key = make_key<MotionStop>(
        Presence::optional, {fmt::format("displacement_{}", translation_axes[axis]), "m", "none", {}, "", ""},
        [](auto& stop) -> auto& { return stop.displacement[axis]; }, number_or("", above_up_to(0, 1e5)));
    key.text.meaning = "Way of the centre of mass along that axis since the phase began, in either direction.";
    return key;
}

Keys<MotionStop> stop_keys()
{
    return {force_stop<0>(),        force_stop<1>(),        force_stop<2>(),
            displacement_stop<0>(), displacement_stop<1>(), displacement_stop<2>()};
}

} // namespace

Keys<Motion> motion_keys()
{
    const char* rotation = "Rotation about that axis.";
    return {
        required("body", "", &Motion::body, name(), "The body: the name of a [[body]]. One motion a body and phase."),
        optional("frame", "", &Motion::frame, word<MotionFrame>(),
                 "Axes of x y z: the world's, or the body's when the phase begins; these do not turn with it."),
        optional(
            "rotation_frame", "", &Motion::rotation_frame, word<MotionFrame>(),
            "Axes of roll pitch yaw, likewise. A wheel with a steering angle or camber turns about its axle alone if "
            "roll and yaw are held in its own axes."),
        translation_key(0, "Translation of the centre of mass."),
        translation_key(1, "Likewise."),
        translation_key(2, "Likewise."),
        rotation_key(0, rotation),
        rotation_key(1, rotation),
        rotation_key(2, rotation),
        axis_key(
            "axle", AxisSort::rotation, [](auto& motion) -> auto& { return motion.axle; },
            "Rotation about the body's own y axis, the axle of a wheel, wherever it points; other than \"free\" only "
            "with a free `pitch`."),
        optional("axle_friction", "N m", &Motion::axle_friction, number(between(0, 1e12)),
                 "Coulomb's torque of the bearing, against rotation about the axle. Its work counts as friction."),
        load_key(),
        table_key<Motion>(Presence::optional, "carriage", "[[phase]] motion carriage", &Motion::carriage,
                          carriage_keys(), "A vertical spring and damper from the body to something that stands still.",
                          "no carriage"),
        table_key<Motion>(Presence::optional, "until", "[[phase]] motion until", &Motion::until, stop_keys(),
                          "The phase ends when one of these is reached; it warns if none is by its `duration`.",
                          "nothing stops it"),
    };
}

Key<Phase> phase_motion_key()
{
    std::vector<TableText> inner = describe_course();
    inner.push_back(describe("[[phase]] motion carriage", "", carriage_keys()));
    inner.push_back(describe("[[phase]] motion until", "", stop_keys()));
    return tables_key<Phase>("motion", "[[phase]] motion", &Phase::motion, motion_keys(),
                             "What moves bodies: prescribed velocities, forces, loads and bearings: docs/phases.md.",
                             "no body has a motion", inner);
}

std::string motion_label(const std::string& phase, std::size_t index)
{
    return fmt::format("{}.motion[{}]", phase, index);
}

} // namespace tread::scene
