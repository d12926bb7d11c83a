#include "scene/validate.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/phase_settings.hpp"
#include "scene/ranges.hpp"

namespace tread::scene
{
namespace
{

template<class T>
void require_unique(const std::string& table, const std::vector<T>& items, Checker& checker)
{
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        const auto first =
            std::find_if(items.begin(), items.end(), [&](const T& item) { return item.name == items[i].name; });
        const auto index = static_cast<std::size_t>(first - items.begin());
        if (index == i || items[i].name.empty()) { continue; }
        checker.report({table, i}, "name",
                       fmt::format("\"{}\" is also the name of [[{}]] {}", items[i].name, table, index),
                       "a name that no other has");
    }
}

/// Whether a density is needed: terrain and rocks take their mass from the material, bodies have their own.
bool needs_density(const Scene& scene, const Material& material)
{
    const auto uses = [&](const auto& item) { return item.material == material.name; };
    return (std::any_of(scene.terrain.begin(), scene.terrain.end(), uses) && material.model != MaterialModel::rigid) ||
           std::any_of(scene.rocks.begin(), scene.rocks.end(), uses);
}

/// The friction angle exceeds the critical one by up to 20 degrees. Loose sand that contracts while it shears has no
/// stable elastic answer once it is nearly incompressible.
void validate_bolton(const Material& material, const TableAt& at, Checker& checker)
{
    constexpr double most_friction = 60, most_poisson = 0.4;
    if (checker.sound(at, {"void_ratio_min", "void_ratio_max"}) && material.void_ratio_min >= material.void_ratio_max)
    {
        checker.report(at, "void_ratio_min", fmt::format("{} is not below void_ratio_max", material.void_ratio_min),
                       fmt::format("number below void_ratio_max = {}", material.void_ratio_max));
    }
    if (checker.sound(at, {"friction_angle_deg"}) && material.friction_angle_deg > most_friction)
    {
        checker.report(at, "friction_angle_deg",
                       fmt::format("{} is too large for \"bolton\"", material.friction_angle_deg),
                       fmt::format("number >= 0 and <= {} (degrees)", most_friction));
    }
    if (checker.sound(at, {"poisson"}) && material.poisson > most_poisson)
    {
        checker.report(at, "poisson", fmt::format("{} is too large for \"bolton\"", material.poisson),
                       fmt::format("number >= 0 and <= {}", most_poisson));
    }
}

/// Checks limitations of a mean density: one mean serves all materials, over whole cells of one size.
void validate_softening(const Scene& scene, const Material& material, const TableAt& at, Checker& checker)
{
    if (!material.softening_length || !checker.sound(at, {"softening_length"})) { return; }
    const double length = *material.softening_length;
    const auto   refuse = [&](const std::string& what, const std::string& accepted)
    { checker.report(at, "softening_length", what, accepted); };
    if (checker.sound({"grid"}, {"spacing"}) && length < scene.grid.spacing)
    {
        refuse(fmt::format("{} is less than a cell, so that it would have no effect", length),
               fmt::format("number >= [grid] spacing = {} (m)", scene.grid.spacing));
    }
    const auto other = [&](const Material& m) { return m.softening_length && *m.softening_length != length; };
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), other);
    if (found != scene.materials.end())
    {
        refuse(fmt::format("{} differs from that of \"{}\"", length, found->name),
               fmt::format("{} (m), one length for all materials", *found->softening_length));
    }
    if (!scene.grid.refine.empty())
    {
        refuse("the mean does not cross the seams of a refined grid", "no [grid] refine");
    }
    if (scene.sleep.distance) { refuse("the mean would miss sand that sleeps", "no [sleep] distance"); }
}

/// Strength must grow with pressure as stiffness does, from none.
void validate_stiffening(const Material& material, const TableAt& at, Checker& checker)
{
    if (material.young_pressure == 0 || material.cohesion == 0) { return; }
    checker.report(at, "young_pressure",
                   fmt::format("stiffness grows from none, but cohesion is {} Pa", material.cohesion),
                   "0 (Pa), or cohesion = 0");
}

void validate_material(const Scene& scene, const Material& material, const TableAt& at, Checker& checker)
{
    if (checker.sound(at, {"friction_angle_deg", "dilation_angle_deg"}) &&
        material.dilation_angle_deg > material.friction_angle_deg)
    {
        checker.report(at, "dilation_angle_deg",
                       fmt::format("{} is above the friction angle", material.dilation_angle_deg),
                       fmt::format("0 to friction_angle_deg = {} (degrees)", material.friction_angle_deg));
    }
    if (checker.sound(at, {"model"}) && material.model == MaterialModel::bolton)
    {
        validate_bolton(material, at, checker);
        validate_softening(scene, material, at, checker);
    }
    if (checker.sound(at, {"young_pressure", "cohesion"})) { validate_stiffening(material, at, checker); }
    if (checker.sound(at, {"model"}) && material.model != MaterialModel::rigid && checker.given(at, "young") == nullptr)
    {
        checker.report(at, "young", "missing", stiffness().text() + " (Pa)");
    }
    if (needs_density(scene, material) && checker.given(at, "density") == nullptr)
    {
        checker.report(at, "density", "missing; terrain or rocks are made of this", density().text() + " (kg/m3)");
    }
}

bool has_wall(const Walls& walls)
{
    const auto kinds = {walls.x, walls.y, walls.bottom, walls.top};
    return std::any_of(kinds.begin(), kinds.end(), [](WallKind kind) { return kind != WallKind::open; });
}

/// Hertz's law takes its stiffness from deformable partners: at least one of two that meet, walls included, must
/// deform.
void validate_stiffness(const Scene& scene, Checker& checker)
{
    constexpr std::int64_t many  = 2; // count assumed for rocks that fill a fraction of a region
    std::int64_t           stiff = 0;
    const auto             check = [&](const std::string& material, std::int64_t count)
    {
        const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                        [&](const Material& candidate) { return candidate.name == material; });
        if (found == scene.materials.end() || !std::isinf(found->young)) { return; }
        stiff += count;
        const TableAt at{"material", static_cast<std::size_t>(found - scene.materials.begin())};
        if ((stiff > 1 || has_wall(scene.domain.walls)) && checker.sound(at, {"model", "young"}))
        {
            checker.report(at, "young",
                           "missing; perfectly stiff, it would meet another perfectly stiff body or the walls",
                           stiffness().text() + " (Pa), or one such body in a domain of open walls");
        }
    };
    for (const auto& rocks : scene.rocks) { check(rocks.material, rocks.count.value_or(many)); }
    for (const auto& body : scene.bodies) { check(body.material, 1); }
}

void validate_drive(const Phase& phase, const TableAt& at, Checker& checker)
{
    const auto& drive = *phase.drive;
    if (std::find(phase.hold.begin(), phase.hold.end(), drive.body) != phase.hold.end())
    {
        checker.report(at, "drive", fmt::format("\"{}\" is both held and driven", drive.body),
                       "a body that `hold` does not name");
    }
    if (drive.slip && drive.angular_velocity == 0 &&
        !mentions(checker.problems, checker.label(at) + ".drive", "angular_velocity"))
    {
        checker.report(at, "drive", "slip is a ratio to the wheel's spin, and angular_velocity is 0",
                       "angular_velocity other than 0, or slip = \"free\"");
    }
}

void validate_lowering(const Scene& scene, const Phase& phase, const TableAt& at, Checker& checker)
{
    const std::string& body = phase.lower->body;
    if (std::find(phase.hold.begin(), phase.hold.end(), body) != phase.hold.end())
    {
        checker.report(at, "lower", fmt::format("\"{}\" is both held and lowered", body),
                       "a body that `hold` does not name");
    }
    if (phase.drive && phase.drive->body == body)
    {
        checker.report(at, "lower", fmt::format("\"{}\" is both driven and lowered", body),
                       "a body that is not driven");
    }
    if (checker.sound({"domain"}, {"gravity", "gravity_size"}) && gravity_in(scene, at.index) == Vector3{})
    {
        checker.report(at, "lower", "a body is lowered along gravity, which is zero in this phase", "gravity");
    }
}

void require_ground(const Scene& scene, Checker& checker)
{
    if (!scene.terrain.empty() || !scene.rocks.empty()) { return; }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    {
        if (!scene.bodies[i].on_surface) { continue; }
        checker.report({"body", i}, "position", "\"on surface\" needs a [[terrain]] or [[rocks]] to stand on",
                       "[x, y, z]");
    }
}

void require_terrain_to_replace(const Scene& scene, Checker& checker)
{
    for (std::size_t i = 0; i < scene.rocks.size(); ++i)
    {
        const Placement placement = scene.rocks[i].placement;
        if (scene.rocks[i].from.empty() && takes_sand(placement))
        {
            const char* named = placement == Placement::points ? "points" : "replace";
            checker.report({"rocks", i}, "placement", fmt::format("\"{}\" needs a [[terrain]] to replace", named),
                           "\"rain\" | \"grid\"");
        }
    }
}

void require_gravity(Checker& checker)
{
    const TableAt at{"domain"};
    if (!checker.sound(at, {}) || checker.given(at, "gravity") != nullptr ||
        checker.given(at, "gravity_size") != nullptr)
    {
        return;
    }
    checker.report(at, "gravity", "missing", vector3(acceleration()).accepted + " (m/s2), or gravity_size");
}

/// Checks limitations of a refined grid; where its boxes may lie is checked when the world is built.
void validate_refinement(const Scene& scene, Checker& checker)
{
    constexpr std::size_t most = 3;
    if (scene.grid.refine.empty()) { return; }
    const auto refuse = [&](const char* what, const char* accepted)
    { checker.report({"grid"}, "refine", what, accepted); };
    if (scene.grid.refine.size() > most) { refuse("more boxes than levels", "at most 3 boxes"); }
    if (scene.numerics.shape_functions != ShapeFunctions::quadratic)
    {
        refuse("linear shape functions cannot be refined", "[numerics] shape_functions = \"quadratic\"");
    }
    if (scene.sleep.distance) { refuse("sand of a refined grid cannot sleep", "no [sleep] distance"); }
    const auto saved = [](const Terrain& terrain) { return !terrain.from.empty(); };
    if (std::any_of(scene.terrain.begin(), scene.terrain.end(), saved))
    {
        refuse("sand of a saved bed does not follow the grid", "[[terrain]] without `from`");
    }
}

void validate_spacing(const Scene& scene, Checker& checker)
{
    if (checker.given({"grid"}, "spacing") == nullptr && checker.sound({"grid"}, {}))
    {
        checker.report({"grid"}, "spacing", "missing; [[terrain]] needs it", length().text() + " (m)");
    }
    validate_refinement(scene, checker);
    const double smallest = *std::min_element(scene.domain.size.begin(), scene.domain.size.end());
    if (scene.grid.spacing > smallest && checker.sound({"domain"}, {"size"}))
    {
        checker.report({"grid"}, "spacing", fmt::format("{} is more than the domain", scene.grid.spacing),
                       between(length().low, smallest).text() + " (m)");
    }
}

/// Checks page numbers: pages of each level of the grid have their own, of 16 bits along each axis.
void validate_cells(const Scene& scene, Checker& checker)
{
    constexpr double most = 262000; // of the smallest cells, along an axis
    if (!checker.sound({"domain"}, {"size"}) || !checker.sound({"grid"}, {"spacing"}) || scene.grid.spacing == 0)
    {
        return;
    }
    const double largest = *std::max_element(scene.domain.size.begin(), scene.domain.size.end());
    const double cells   = largest / scene.grid.finest();
    if (cells <= most) { return; }
    checker.report({"grid"}, "spacing",
                   fmt::format("{} gives {:.3g} cells along the domain's longest edge, over {:.0f}", scene.grid.spacing,
                               cells, most),
                   fmt::format("number >= {} (m)", scene.grid.spacing * cells / most));
}

} // namespace

void validate(const Scene& scene, const Node& document, Problems& problems)
{
    Checker checker{document, problems};
    require_gravity(checker);
    validate_names(scene, checker);
    validate_references(scene, checker);
    validate_materials(scene, checker);
    validate_shapes(scene, checker);
    validate_places(scene, checker);
    validate_bodies(scene, checker);
    validate_joints(scene, checker);
    validate_phases(scene, checker);
    validate_touch(scene, checker);
    validate_motions(scene, checker);
    validate_contents(scene, checker);
    validate_cells(scene, checker);
}

void validate_names(const Scene& scene, Checker& checker)
{
    require_unique("material", scene.materials, checker);
    require_unique("shape", scene.shapes, checker);
    require_unique("body", scene.bodies, checker);
    require_unique("joint", scene.joints, checker);
    require_unique("phase", scene.phases, checker);
}

void validate_materials(const Scene& scene, Checker& checker)
{
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
    {
        validate_material(scene, scene.materials[i], {"material", i}, checker);
    }
    validate_stiffness(scene, checker);
}

void validate_phases(const Scene& scene, Checker& checker)
{
    for (std::size_t i = 0; i < scene.phases.size(); ++i)
    {
        if (scene.phases[i].drive) { validate_drive(scene.phases[i], {"phase", i}, checker); }
        if (scene.phases[i].lower) { validate_lowering(scene, scene.phases[i], {"phase", i}, checker); }
    }
}

void validate_contents(const Scene& scene, Checker& checker)
{
    const auto absent = [&](const char* table)
    {
        const Node* node  = find(checker.document, table);
        const auto* array = node != nullptr ? std::get_if<NodeArray>(&node->value) : nullptr;
        return node == nullptr || (array != nullptr && array->empty());
    };
    if (absent("phase")) { checker.report({"phase"}, "", "missing", "at least one [[phase]]"); }
    if (absent("terrain") && absent("rocks") && absent("body"))
    {
        checker.problems.push_back(
            {checker.document.where, "", "", "the scene is empty", "at least one of [[terrain]], [[rocks]], [[body]]"});
    }
    if (absent("terrain")) { require_terrain_to_replace(scene, checker); }
    else { validate_spacing(scene, checker); }
    require_ground(scene, checker);
    if (scene.output.bed_after.empty()) { return; }
    if (absent("rocks") && absent("terrain"))
    {
        checker.report({"output"}, "bed_after", "there is no bed to save", "a scene with [[terrain]] or [[rocks]]");
    }
}

} // namespace tread::scene
