#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/phase.hpp"
#include "scene/words.hpp"

// What the user asked for, as plain data in SI units (angles in degrees where the name says so).
// Defaults, units, ranges and meanings stand in keys.cpp, the one table that parses, validates and documents.
namespace tread::scene
{

using Vector3 = std::array<double, 3>;

struct Walls
{
    WallKind x      = WallKind::slip; ///< both walls normal to x
    WallKind y      = WallKind::slip;
    WallKind bottom = WallKind::fixed;
    WallKind top    = WallKind::open;

    double friction = 0.5; ///< of frictional walls with sand

    bool operator==(const Walls&) const = default;
};

struct Domain
{
    Vector3 size{};    ///< m; the domain is [0, size]
    Vector3 gravity{}; ///< m/s2
    Walls   walls;

    bool operator==(const Domain&) const = default;
};

struct Box
{
    Vector3 low{};
    Vector3 high{};

    bool operator==(const Box&) const = default;
};

struct GridOptions
{
    double           spacing = 0; ///< m
    std::vector<Box> refine;      ///< m; half the spacing in the first, half of that in the second, and so on

    /// m, in the last of the boxes.
    double finest() const { return spacing / static_cast<double>(1 << refine.size()); }

    bool operator==(const GridOptions&) const = default;
};

/// Contact substeps of a step: more never come to an end that anybody waits for.
inline constexpr std::int64_t most_substeps = 1000000;

struct TimeOptions
{
    std::optional<double>       dt;       ///< s; nothing means "auto"
    std::optional<std::int64_t> substeps; ///< contact substeps a step; nothing means "auto"
    double                      contact_share =
        0.2; ///< of sqrt(m / sum K), what automatic substeps take: docs/theory.md#time-step (measured limit: 1.1)

    bool operator==(const TimeOptions&) const = default;
};

struct Numerics
{
    Precision             precision = Precision::single_;
    Transfer              transfer  = Transfer::aflip;
    std::optional<double> pic_rate; ///< PIC part of FLIP per unit time, in units of c_p/h; nothing = by material
    ShapeFunctions        shape_functions = ShapeFunctions::quadratic;
    NarrowPhase           narrow_phase    = NarrowPhase::sdf;
    PointMotion           point_motion    = PointMotion::supported;
    HertzFactor           hertz           = HertzFactor::standard;
    PointRadius           point_radius    = PointRadius::sphere;
    double                refine_below    = 0;    ///< point radii: smaller bodies are sampled at nine places; 0 = none
    double                linear_overlap  = 1e-3; ///< d0/R* under which the body-body traction is linear
    VolumeStrain          volume_strain   = VolumeStrain::point;

    bool operator==(const Numerics&) const = default;
};

struct Material
{
    std::string   name;
    MaterialModel model   = MaterialModel::elastic;
    double        density = 0; ///< kg/m3
    double        young   = 0; ///< Pa; infinity: perfectly stiff, for a rigid material whose scene gives none
    double        poisson = 0.3;
    double        friction_angle_deg = 0; ///< granular models
    double        dilation_angle_deg = 0;
    double        cohesion           = 0; ///< Pa
    std::string   family;                 ///< contact class; default: the material's own name
    ConeFit       drucker_prager_fit = ConeFit::compression;

    bool operator==(const Material&) const = default;
};

/// Friction and restitution of one unordered pair of families.
struct Contact
{
    std::array<std::string, 2> between;
    double                     friction    = 0.3;
    double                     restitution = 0.5; ///< body-body only

    double rolling_friction = 0; ///< mu_r, body-body only

    bool operator==(const Contact&) const = default;
};

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

/// A rigid wheel: drum with grousers, open or with flanges, web and hub; axle along the mesh's y. Lengths in metres.
struct WheelGenerator
{
    double radius         = 0.26; ///< over the grousers
    double width          = 0.33;
    double wall_thickness = 0.0095;
    int    grousers       = 48;
    double grouser_height = 0.0125;
    double grouser_width  = 0.004;

    GrouserShape grouser_shape     = GrouserShape::straight;
    double       grouser_sweep_deg = 0; ///< from a grouser's middle to its ends, about the axle, degrees
    double       crown             = 0; ///< the drum's radius at its edges is smaller by this; parabolic
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
    double      unit   = 1.0;   ///< metres a mesh unit
    bool        repair = false; ///< mend the mesh, and take winding numbers where that does not close it

    bool operator==(const MeshFile&) const = default;
};

using ShapeSource = std::variant<RockGenerator, SphereGenerator, WheelGenerator, MeshFile>;

struct Shape
{
    std::string                 name;
    ShapeSource                 source;
    std::optional<std::int64_t> sdf_cells; ///< along the longest axis of the 120 % box; nothing = by the thinnest wall
    double                      node_spacing = 0; ///< m; surface nodes; 0 = by the generator, or a 40th of the extent

    bool operator==(const Shape&) const = default;
};

struct Sphere
{
    Vector3 centre{};
    double  radius = 0; ///< m

    bool operator==(const Sphere&) const = default;
};

/// Exactly one of box and sphere is set in a loaded scene: the domain's box where the scene names neither.
struct Region
{
    std::optional<Box>    box;
    std::optional<Sphere> sphere;
    std::vector<Box>      except; ///< cut out

    bool operator==(const Region&) const = default;
};

/// A height (m) as a function of x and y (m).
struct Formula
{
    std::string text;

    bool operator==(const Formula&) const = default;
};

using PlanExtent = std::array<std::array<double, 2>, 2>;

/// Heights on a rectangular lattice: the grey values of a PGM, or the numbers of a CSV. The first row is at high y.
struct RasterFile
{
    std::string               path;       ///< absolute, or relative to the scene file
    double                    low  = 0;   ///< m, of black; PGM only
    double                    high = 0;   ///< m, of white; PGM only
    double                    unit = 1.0; ///< metres a CSV's unit
    std::optional<PlanExtent> extent;     ///< m, where the outermost samples stand; in a loaded scene always set

    bool operator==(const RasterFile&) const = default;
};

using Height = std::variant<Formula, RasterFile>;

struct Terrain
{
    std::string           material;
    std::string           from; ///< absolute path of a saved bed; empty = points on a lattice
    Region                region;
    std::optional<Height> height;              ///< upper surface
    std::optional<Height> floor;               ///< lower surface
    int                   points_per_cell = 8; ///< a cube number: 1, 8, 27, 64
    std::optional<double> spacing;             ///< m, of a lattice from the region's low corner; instead of the above
    Vector3               velocity{};          ///< m/s, at the start

    bool operator==(const Terrain&) const = default;
};

struct UniformDiameters
{
    double low  = 0; ///< m
    double high = 0;

    bool operator==(const UniformDiameters&) const = default;
};

/// ln d is normal with this deviation about ln(median), d truncated to [low, high].
struct LogNormalDiameters
{
    double median    = 0; ///< m
    double deviation = 0; ///< of ln d
    double low       = 0; ///< m
    double high      = 0;

    bool operator==(const LogNormalDiameters&) const = default;
};

/// Number density ~ d^-exponent in [low, high].
struct PowerLawDiameters
{
    double exponent = 0;
    double low      = 0; ///< m
    double high     = 0;

    bool operator==(const PowerLawDiameters&) const = default;
};

/// m, of spheres of equal volume: one for all, or a distribution by number.
using Diameter = std::variant<double, UniformDiameters, LogNormalDiameters, PowerLawDiameters>;

struct Rocks
{
    std::string                 shape;
    std::string                 material;
    std::string                 from;  ///< absolute path of a saved bed; empty = the rocks are drawn and placed
    std::optional<std::int64_t> count; ///< exactly one of count, solid_fraction
    std::optional<double>       solid_fraction; ///< volume of the rocks over that of the region
    Diameter                    diameter = 0.0;
    Region                      region;
    std::optional<Height>       height; ///< surfaces between which the rocks lie
    std::optional<Height>       floor;
    Placement                   placement   = Placement::replace;
    bool                        allow_voids = false; ///< in the sand around rocks that take its place
    std::uint64_t               seed        = 1;

    bool operator==(const Rocks&) const = default;
};

struct Body
{
    std::string              name;
    std::string              shape; ///< a [[shape]], or a built-in wheel
    std::string              material;
    std::optional<double>    diameter;           ///< m, of the sphere of equal volume; default: the shape's own size
    std::optional<double>    density;            ///< kg/m3; exactly one of density, mass, load
    std::optional<double>    mass;               ///< kg
    std::optional<double>    load;               ///< N under the scene's gravity
    Vector3                  position{};         ///< m, of the centre of mass; its z is 0 if the body stands on_surface
    bool                     on_surface = false; ///< z follows from what lies under the body
    double                   gap        = 0;     ///< m, between what lies there and the body's lowest point
    Vector3                  velocity{};         ///< m/s, when first released
    std::optional<double>    rolling_radius;     ///< m; default: over the grousers
    std::vector<std::string> lock;               ///< world degrees of freedom held fixed: x y z roll pitch yaw

    bool operator==(const Body&) const = default;
};

struct Output
{
    double every           = 0.02; ///< s, time series
    double snapshots_every = 0;    ///< s; 0 = none

    std::string bed_after; ///< phase at whose end rocks and sand are saved; empty = none

    bool operator==(const Output&) const = default;
};

/// When the whole state is written, to go on from.
struct CheckpointOptions
{
    double       every_wall  = 600; ///< s of wall time; 0 = never
    double       every_time  = 0;   ///< s of simulated time; 0 = never
    std::int64_t every_steps = 0;   ///< 0 = never
    std::int64_t keep        = 2;   ///< newest that stay

    bool operator==(const CheckpointOptions&) const = default;
};

/// How a run on several ranks deals out its pages.
struct Balance
{
    double threshold = 1.15; ///< largest load of a rank over the mean above which pages may be dealt out anew

    bool operator==(const Balance&) const = default;
};

/// Sand that lies still, far from what moves, is left out of the steps.
struct Sleep
{
    std::optional<double> distance;     ///< m from every body; nothing = no sand sleeps
    double                speed = 0.01; ///< m/s that what sleeps was never over
    double                rest  = 0.05; ///< s for which it was not
    double                load  = 0.2;  ///< change of the pressure on it that wakes it, over the bed's mean on its base

    bool operator==(const Sleep&) const = default;
};

/// What is known of the right answer. `tread study` compares runs with it; no run reads it.
struct Reference
{
    ReferenceForm form = ReferenceForm::none;
    std::string   file; ///< of times and values; absolute when loaded; empty = none

    bool operator==(const Reference&) const = default;
};

/// Where tables of lists were written ("sand.toml:41"), by their names in messages ("rocks[0]", "body.wheel"): for
/// errors that only the world of a scene shows. No part of what the scene says, so that any two are equal.
struct Lines
{
    std::map<std::string, std::string> of;

    bool operator==(const Lines& /*other*/) const { return true; }
};

struct Scene
{
    std::string           title;
    Domain                domain;
    GridOptions           grid;
    TimeOptions           time;
    Numerics              numerics;
    std::vector<Material> materials;
    std::vector<Contact>  contacts;
    std::vector<Shape>    shapes;
    std::vector<Terrain>  terrain;
    std::vector<Rocks>    rocks;
    std::vector<Body>     bodies;
    std::vector<Phase>    phases;
    Output                output;
    CheckpointOptions     checkpoint;
    Balance               balance;
    Sleep                 sleep;
    Reference             reference;
    std::string           directory; ///< of the scene file; mesh paths are relative to it
    Lines                 lines;

    bool operator==(const Scene&) const = default;
};

} // namespace tread::scene
