#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
#include "scene/named.hpp"
#include "scene/problems.hpp"
#include "shape/template.hpp"

namespace tread::shape
{
namespace
{

// Radii are over the grousers. Real skins are about 1 mm thick, far below any grid's resolution: walls are thickened
// inwards, where they do not touch the ground. Spokes are omitted. "Assumed" marks values without a source. With these
// cells the SDF encloses the mesh's volume within 1 % (measured by the unit tests); the sizes in MB are those of the
// SDF.

/// The wheel of the paper: radius 0.26 m and volume 0.0058 m3, from which the wall follows; width 0.33 m from
/// NASA/JPL's public m2020 robot description; 48 gently curved grousers (NASA, "Perseverance Mars Rover Gets Its Wheels
/// and Air Brakes", 2020). Grousers of 12.5 x 4 mm and their bow of 4 degrees: assumed. 10 MB.
scene::WheelGenerator perseverance()
{
    scene::WheelGenerator wheel{0.26, 0.33, 0.00996, 48, 0.0125, 0.004};
    wheel.grouser_shape     = scene::GrouserShape::curved;
    wheel.grouser_sweep_deg = 4;
    return wheel;
}

/// Diameter 0.50 m, width 0.40 m, 24 chevrons 15 degrees apart and 7.5 mm high (JPL 2016, Mars Science Laboratory
/// wheels). One V across the width with its ends 10 degrees ahead, grouser width 5 mm and wall 10 mm: assumed. The
/// visual odometry marker, where five chevrons differ, is omitted.
scene::WheelGenerator curiosity()
{
    scene::WheelGenerator wheel{0.25, 0.40, 0.01, 24, 0.0075, 0.005};
    wheel.grouser_shape     = scene::GrouserShape::chevron;
    wheel.grouser_sweep_deg = 10;
    return wheel;
}

/// Mars Exploration Rover: diameter 0.26 m, width 0.16 m, crowned, cleats of about 1 cm, flexures and foam between hub
/// and rim (Lindemann & Voorhees 2005, IEEE SMC). 24 cleats of 4 mm, wall 6 mm, crown 8 mm, and for flexures and foam a
/// disc of 8 mm on a hub of 80 x 60 mm: assumed.
scene::WheelGenerator spirit()
{
    scene::WheelGenerator wheel{0.13, 0.16, 0.006, 24, 0.01, 0.004};
    wheel.crown         = 0.008;
    wheel.hub_radius    = 0.04;
    wheel.hub_width     = 0.06;
    wheel.web_thickness = 0.008;
    return wheel;
}

/// VIPER as in Project Chrono's viper_wheel.h: drum radius 0.225 m, 24 straight grousers of 25 x 5 mm, width 0.20 m.
/// Wall 10 mm: assumed.
scene::WheelGenerator viper() { return {0.25, 0.20, 0.01, 24, 0.025, 0.005}; }

std::vector<scene::Shape> builtin_wheels()
{
    return {{"perseverance", perseverance(), 200, 0},
            {"curiosity", curiosity(), 160, 0},
            {"spirit", spirit(), 112, 0},
            {"viper", viper(), 160, 0}};
}

/// Looks up the shapes of an assembly's parts, of a family of rocks its first.
scene::Shape with_parts(const scene::Scene& scene, scene::Shape shape)
{
    const auto* assembly = std::get_if<scene::Assembly>(&shape.source);
    if (assembly == nullptr) { return shape; }
    for (const scene::AssemblyPart& part : assembly->parts)
    {
        shape.parts.push_back(members(find_shape(scene, part.shape)).front());
    }
    return shape;
}

} // namespace

std::vector<std::string> builtin_shape_names()
{
    std::vector<std::string> names;
    for (const scene::Shape& wheel : builtin_wheels()) { names.push_back(wheel.name); }
    return names;
}

scene::Shape find_shape(const scene::Scene& scene, const std::string& name)
{
    std::vector<scene::Shape>       known    = scene.shapes;
    const std::vector<scene::Shape> builtins = builtin_wheels();
    known.insert(known.end(), builtins.begin(), builtins.end());
    const std::size_t found = scene::index_of(known, name);
    if (found < known.size()) { return with_parts(scene, known[found]); }

    std::vector<std::string> names;
    names.reserve(known.size());
    for (const scene::Shape& shape : known) { names.push_back(shape.name); }
    throw InputError(fmt::format("shape '{}' is unknown{}; known are {}; the file of a mesh ends in .stl or .obj", name,
                                 scene::suggestion(name, names), fmt::join(names, ", ")));
}

} // namespace tread::shape
