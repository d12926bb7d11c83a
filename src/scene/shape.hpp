#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/vector3.hpp"
#include "scene/words.hpp"

// Shapes of a scene as plain data: generators and their parameters, mesh files, assemblies. Metres.
namespace tread::scene
{

struct RockGenerator
{
    std::uint64_t         seed       = 1;
    double                aspect     = 0.75; ///< smallest over largest extent
    double                sphericity = 0.90;
    int                   nodes      = 162;          ///< surface nodes
    std::optional<double> elongation = std::nullopt; ///< middle over largest extent; default: (1 + aspect)/2
    double                solidity   = 0.98;         ///< volume over that of the convex hull
    int                   variants   = 1;            ///< rocks in the family

    bool operator==(const RockGenerator&) const = default;
};

struct SphereGenerator
{
    int nodes = 642;

    bool operator==(const SphereGenerator&) const = default;
};

/// A rigid wheel: drum with grousers, open or with flanges, web and hub; the axle is the mesh's y axis. Lengths in
/// metres.
struct WheelGenerator
{
    double radius         = 0.26; ///< over the grousers
    double width          = 0.33;
    double wall_thickness = 0.0095;
    int    grousers       = 48;
    double grouser_height = 0.0125;
    double grouser_width  = 0.004;

    GrouserShape grouser_shape     = GrouserShape::straight;
    double       grouser_sweep_deg = 0; ///< degrees about the axle, from a grouser's middle to its ends
    double       crown             = 0; ///< reduction of the drum's radius at its edges; parabolic
    double       rim_height        = 0; ///< of the flanges inside the drum's edges; 0 = none
    double       rim_thickness     = 0;
    double       hub_radius        = 0; ///< 0 = open rim
    double       hub_width         = 0;
    double       web_thickness     = 0;

    bool operator==(const WheelGenerator&) const = default;
};

struct MeshFile
{
    std::string path;           ///< absolute, or relative to the scene file
    double      unit   = 1.0;   ///< metres per mesh unit
    bool        repair = false; ///< repair the mesh, and use winding numbers if it cannot be closed

    bool operator==(const MeshFile&) const = default;
};

struct BoxGenerator
{
    Vector3 size{};

    bool operator==(const BoxGenerator&) const = default;
};

/// A flat disc or rectangle normal to z. In a loaded scene exactly one of radius and size is set.
struct PlateGenerator
{
    std::optional<double>  radius;
    std::optional<Vector2> size;
    double                 thickness = 0;

    bool operator==(const PlateGenerator&) const = default;
};

/// A solid cylinder about z.
struct CylinderGenerator
{
    double radius = 0;
    double length = 0;

    bool operator==(const CylinderGenerator&) const = default;
};

/// A cone about z with its tip down, and a shaft on its base.
struct ConeGenerator
{
    double apex_angle_deg = 30; ///< the full angle
    double base_radius    = 0;
    double shaft_radius   = 0; ///< 0 = no shaft
    double shaft_length   = 0;

    bool operator==(const ConeGenerator&) const = default;
};

/// An annulus about z, with radial vanes on its lower face.
struct RingGenerator
{
    double inner_radius   = 0;
    double outer_radius   = 0;
    double height         = 0; ///< of the annulus, without its vanes
    int    vanes          = 0;
    double vane_height    = 0;
    double vane_thickness = 0;

    bool operator==(const RingGenerator&) const = default;
};

/// A hollow cylinder about z, open at both ends.
struct TubeGenerator
{
    double radius         = 0; ///< outer
    double wall_thickness = 0;
    double length         = 0;

    bool operator==(const TubeGenerator&) const = default;
};

/// Four vertical walls around a rectangle, open above; with a floor a tray, without one a frame.
struct FrameGenerator
{
    Vector2 inner_size{};
    double  height          = 0; ///< over all, with the floor
    double  wall_thickness  = 0;
    double  floor_thickness = 0; ///< 0 = open below

    bool operator==(const FrameGenerator&) const = default;
};

/// A shape within an assembly: scaled, then rotated about its own origin, then moved.
struct AssemblyPart
{
    std::string shape;         ///< a [[shape]] or a built-in wheel
    Vector3     at{};          ///< m, of the part's origin
    Vector3     axis{0, 0, 1}; ///< any length but 0
    double      angle_deg = 0; ///< about the axis, right-handed
    double      scale     = 1;

    bool operator==(const AssemblyPart&) const = default;
};

/// The union of other shapes.
struct Assembly
{
    std::vector<AssemblyPart> parts;

    bool operator==(const Assembly&) const = default;
};

using ShapeSource =
    std::variant<RockGenerator, SphereGenerator, WheelGenerator, MeshFile, BoxGenerator, PlateGenerator,
                 CylinderGenerator, ConeGenerator, RingGenerator, TubeGenerator, FrameGenerator, Assembly>;

struct Shape
{
    std::string                 name;
    ShapeSource                 source;
    std::optional<std::int64_t> sdf_cells; ///< along the longest axis of the 120 % box; empty = by the thinnest wall
    double node_spacing = 0; ///< m; spacing of surface nodes; 0 = by the generator, or a 40th of the extent

    /// Shapes of an assembly's parts, in their order. Empty in a loaded scene: shape::find_shape looks them up.
    std::vector<Shape> parts = {};

    bool operator==(const Shape&) const = default;
};

} // namespace tread::scene
