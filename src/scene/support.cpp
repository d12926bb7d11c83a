#include "scene/support.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "scene/contacts.hpp"
#include "scene/keys.hpp"
#include "scene/named.hpp"
#include "scene/phase_settings.hpp"

namespace tread::scene
{
namespace
{

bool moves_as_told(const Motion& motion)
{
    return std::any_of(motion.translation.begin(), motion.translation.end(),
                       [](const AxisMotion& axis)
                       { return axis.kind == AxisKind::held || axis.kind == AxisKind::velocity; });
}

/// What bodies of a scene can push against in a phase.
struct Supports
{
    const Scene&         scene;
    const Phase&         phase;
    std::vector<Contact> contacts;

    bool touches(const Body& body, const std::string& family) const
    {
        return contact_of(contacts, family_of(scene, body.material), family).touch;
    }

    bool is_tied(const std::string& one, const std::string& other) const
    {
        const auto ties = [&](const Joint& joint)
        {
            return (joint.between[0] == one && joint.between[1] == other) ||
                   (joint.between[0] == other && joint.between[1] == one);
        };
        return std::any_of(scene.joints.begin(), scene.joints.end(), ties);
    }

    bool pushes(const Body& one, const Body& other) const
    {
        return is_tied(one.name, other.name) || touches(one, family_of(scene, other.material));
    }

    bool is_grounded(const Body& body) const
    {
        const Walls& walls = scene.domain.walls;
        const bool walled  = walls.x != WallKind::open || walls.y != WallKind::open || walls.bottom != WallKind::open ||
                            walls.top != WallKind::open;
        const auto met = [&](const auto& ground) { return touches(body, family_of(scene, ground.material)); };
        return is_tied(body.name, world_side) || (walled && touches(body, std::string(wall_family))) ||
               std::any_of(scene.terrain.begin(), scene.terrain.end(), met) ||
               std::any_of(scene.rocks.begin(), scene.rocks.end(), met);
    }

    /// Whether the phase or the body's locks hold or prescribe some of its translation.
    bool is_led(const Body& body) const
    {
        const Motion* motion = motion_of(phase, body.name);
        const auto    locked = [&](const char* axis) { return contains(body.lock, axis); };
        return contains(phase.hold, body.name) || (motion != nullptr && moves_as_told(*motion)) ||
               (phase.drive && phase.drive->body == body.name) || (phase.lower && phase.lower->body == body.name) ||
               std::any_of(translation_axes.begin(), translation_axes.end(), locked);
    }
};

} // namespace

bool has_support(const Scene& scene, std::size_t phase, std::size_t body)
{
    const Supports           supports{scene, scene.phases[phase], contacts_in(scene, phase)};
    std::vector<std::size_t> reached{body};
    for (std::size_t k = 0; k < reached.size(); ++k)
    {
        const Body& one = scene.bodies[reached[k]];
        if (supports.is_grounded(one) || (k > 0 && supports.is_led(one))) { return true; }
        for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        {
            const bool known = std::find(reached.begin(), reached.end(), b) != reached.end();
            if (!known && supports.pushes(one, scene.bodies[b])) { reached.push_back(b); }
        }
    }
    return false;
}

} // namespace tread::scene
