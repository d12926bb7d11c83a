#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "scene/checker.hpp"
#include "scene/keys.hpp"

namespace tread::scene
{
namespace
{

const Material* find_material(const Scene& scene, const std::string& name)
{
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const Material& material) { return material.name == name; });
    return found == scene.materials.end() ? nullptr : &*found;
}

/// Checks that the material exists and that this table can use its model.
void check_material(const Scene& scene, const TableAt& at, const std::string& name,
                    const std::function<bool(MaterialModel)>& suits, const std::string& accepted, Checker& checker)
{
    checker.require_known(at, "material", name, names_in(scene.materials), "[[material]]");
    const auto* material = find_material(scene, name);
    if (material == nullptr || suits(material->model)) { return; }
    const auto index = static_cast<std::size_t>(material - scene.materials.data());
    if (!checker.sound({"material", index}, {"model"})) { return; }
    checker.report(at, "material", fmt::format("the model of \"{}\" does not suit [[{}]]", name, at.name), accepted);
}

/// Refuses a saved bed of a material whose state beds do not hold.
void check_saved_material(const Scene& scene, std::size_t terrain, Checker& checker)
{
    const auto* material = find_material(scene, scene.terrain[terrain].material);
    if (scene.terrain[terrain].from.empty() || material == nullptr) { return; }
    const bool capped = material->model == MaterialModel::drucker_prager_cap;
    if (!capped && material->model != MaterialModel::bolton) { return; }
    checker.report(
        {"terrain", terrain}, "from",
        fmt::format("a saved bed has no {} of \"{}\"", capped ? "pressure of the cap" : "densities", material->name),
        "no `from` with model = \"drucker-prager-cap\" or \"bolton\"");
}

std::vector<std::string> shape_names(const Scene& scene)
{
    auto names = names_in(scene.shapes);
    names.insert(names.end(), builtin_wheels.begin(), builtin_wheels.end());
    return names;
}

void check_materials(const Scene& scene, Checker& checker)
{
    const auto        points = [](MaterialModel model) { return model != MaterialModel::rigid; };
    const auto        solid  = [](MaterialModel model) { return !is_granular(model); };
    const std::string stiff  = "a material of model \"elastic\" | \"rigid\"";
    for (std::size_t i = 0; i < scene.terrain.size(); ++i)
    {
        check_material(scene, {"terrain", i}, scene.terrain[i].material, points,
                       "a material whose model is not \"rigid\"", checker);
        check_saved_material(scene, i, checker);
    }
    for (std::size_t i = 0; i < scene.rocks.size(); ++i)
    {
        check_material(scene, {"rocks", i}, scene.rocks[i].material, solid, stiff, checker);
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    {
        check_material(scene, {"body", i}, scene.bodies[i].material, solid, stiff, checker);
    }
}

void check_shapes(const Scene& scene, Checker& checker)
{
    for (std::size_t i = 0; i < scene.rocks.size(); ++i)
    {
        checker.require_known({"rocks", i}, "shape", scene.rocks[i].shape, names_in(scene.shapes), "[[shape]]");
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    {
        checker.require_known({"body", i}, "shape", scene.bodies[i].shape, shape_names(scene), "shape");
    }
}

void check_phases(const Scene& scene, Checker& checker)
{
    const auto bodies = names_in(scene.bodies);
    for (std::size_t i = 0; i < scene.phases.size(); ++i)
    {
        const auto& phase = scene.phases[i];
        for (const auto& held : phase.hold) { checker.require_known({"phase", i}, "hold", held, bodies, "[[body]]"); }
        const auto require_body = [&](const auto& table, const char* key)
        {
            if (!table || mentions(checker.problems, checker.label({"phase", i}) + "." + key, "body")) { return; }
            checker.require_known({"phase", i}, key, table->body, bodies, "[[body]]");
        };
        require_body(phase.drive, "drive");
        require_body(phase.lower, "lower");
        require_body(phase.weight, "weight");
    }
}

void check_output(const Scene& scene, Checker& checker)
{
    if (scene.output.bed_after.empty()) { return; }
    checker.require_known({"output"}, "bed_after", scene.output.bed_after, names_in(scene.phases), "[[phase]]");
}

void check_contact(const Scene& scene, std::size_t index, const std::vector<std::string>& families, Checker& checker)
{
    const TableAt at{"contact", index};
    if (!checker.sound(at, {"between"})) { return; }
    const auto& pair = scene.contacts[index].between;
    for (const auto& family : pair) { checker.require_known(at, "between", family, families, "contact family"); }
    if (pair[0] == wall_family && pair[1] == wall_family)
    {
        checker.report(at, "between", "walls do not meet each other", "a family and \"wall\"");
    }
    for (std::size_t i = 0; i < index; ++i)
    {
        const auto& other = scene.contacts[i].between;
        if (std::is_permutation(pair.begin(), pair.end(), other.begin()))
        {
            checker.report(at, "between", fmt::format("the same pair as [[contact]] {}", i), "a pair given once");
            return;
        }
    }
}

/// Settings of contacts in a phase name known families, each pair once, and set something.
void check_contact_settings(const Scene& scene, std::size_t phase, const std::vector<std::string>& families,
                            Checker& checker)
{
    const TableAt at{"phase", phase};
    if (!checker.sound(at, {"contacts"})) { return; }
    const std::vector<ContactSetting>& settings = scene.phases[phase].contacts;
    for (auto setting = settings.begin(); setting != settings.end(); ++setting)
    {
        const auto& pair = setting->between;
        for (const auto& family : pair) { checker.require_known(at, "contacts", family, families, "contact family"); }
        const std::string text = fmt::format("[\"{}\", \"{}\"]", pair[0], pair[1]);
        if (pair[0] == wall_family && pair[1] == wall_family)
        {
            checker.report(at, "contacts", "walls do not meet each other", "a family and \"wall\"");
        }
        if (!setting->friction && !setting->restitution && !setting->touch)
        {
            checker.report(at, "contacts", text + " sets nothing", "friction, restitution or touch");
        }
        const bool again = std::any_of(settings.begin(), setting,
                                       [&](const ContactSetting& before) {
                                           return std::is_permutation(pair.begin(), pair.end(), before.between.begin());
                                       });
        if (again) { checker.report(at, "contacts", text + " twice", "one setting each"); }
    }
}

void check_families(const Scene& scene, Checker& checker)
{
    std::vector<std::string> families{std::string(wall_family)};
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
    {
        const TableAt at{"material", i};
        const auto&   family = scene.materials[i].family;
        families.push_back(family);
        if (family != wall_family) { continue; }
        checker.report(at, checker.given(at, "family") != nullptr ? "family" : "name",
                       "\"wall\" is reserved for the domain's walls", "another family");
    }
    for (std::size_t i = 0; i < scene.contacts.size(); ++i) { check_contact(scene, i, families, checker); }
    for (std::size_t i = 0; i < scene.phases.size(); ++i) { check_contact_settings(scene, i, families, checker); }
}

} // namespace

void validate_references(const Scene& scene, Checker& checker)
{
    check_materials(scene, checker);
    check_shapes(scene, checker);
    check_phases(scene, checker);
    check_output(scene, checker);
    check_families(scene, checker);
}

} // namespace tread::scene
