#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/joint.hpp"
#include "scene/phase.hpp"
#include "scene/shape.hpp"
#include "scene/vector3.hpp"
#include "scene/words.hpp"

// The scene as plain data in SI units (angles in degrees where the name says so). keys.cpp, the one table that parses,
// validates and documents, holds defaults, units, ranges and meanings.
namespace tread::scene
{

struct Walls
{
    WallKind x      = WallKind::slip; ///< both walls normal to x
    WallKind y      = WallKind::slip;
    WallKind bottom = WallKind::fixed;
    WallKind top    = WallKind::open;

    double friction = 0.5; ///< of frictional walls against sand

    bool operator==(const Walls&) const = default;
};

/// Gravity as magnitude and slope of the ground: replaces the vector in a scene file.
struct Slope
{
    std::optional<double> gravity;           ///< m/s2, magnitude
    double                angle_deg     = 0; ///< positive: the ground rises along `direction_deg`
    double                direction_deg = 0; ///< in the ground's plane, from +x towards +y

    bool operator==(const Slope&) const = default;
};

struct Domain
{
    Vector3 size{};    ///< m; the domain is [0, size]
    Vector3 gravity{}; ///< m/s2
    Slope   slope;     ///< empty in a loaded scene, whose gravity is a vector
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
    std::vector<Box> refine;      ///< m; the first halves the spacing, the second halves it again, and so on

    /// Grid spacing (m) in the last of the boxes.
    double finest() const { return spacing / static_cast<double>(1 << refine.size()); }

    bool operator==(const GridOptions&) const = default;
};

/// Largest number of contact substeps in a step; a run with more would not finish in reasonable time.
inline constexpr std::int64_t most_substeps = 1000000;

struct TimeOptions
{
    std::optional<double>       dt;       ///< s; empty means "auto"
    std::optional<std::int64_t> substeps; ///< contact substeps per step; empty means "auto"
    double                      contact_share =
        0.2; ///< share of sqrt(m / sum K) used by automatic substeps: docs/theory.md#time-step (measured limit: 1.1)
    double mass_scaling = 1; ///< largest factor on the inertia of rocks in stiff contact; 1: none

    bool operator==(const TimeOptions&) const = default;
};

struct Numerics
{
    Precision             precision = Precision::single_;
    Transfer              transfer  = Transfer::aflip;
    std::optional<double> pic_rate; ///< PIC part of FLIP per unit time, in units of c_p/h; empty = by material
    ShapeFunctions        shape_functions = ShapeFunctions::quadratic;
    NarrowPhase           narrow_phase    = NarrowPhase::sdf;
    PointMotion           point_motion    = PointMotion::supported;
    HertzFactor           hertz           = HertzFactor::standard;
    PointRadius           point_radius    = PointRadius::sphere;
    double                refine_below = 0; ///< in point radii: smaller bodies are sampled at nine positions; 0 = none
    double                linear_overlap = 1e-3; ///< d0/R* below which the body-body traction is linear
    VolumeStrain          volume_strain  = VolumeStrain::point;

    bool operator==(const Numerics&) const = default;
};

struct Material
{
    std::string   name;
    MaterialModel model   = MaterialModel::elastic;
    double        density = 0; ///< kg/m3
    double        young   = 0; ///< Pa; infinity: perfectly stiff, for a rigid material without a given modulus
    double        poisson = 0.3;
    double        friction_angle_deg = 0; ///< granular models
    double        dilation_angle_deg = 0;
    double        cohesion           = 0; ///< Pa
    std::string   family;                 ///< contact class; default: the material's own name
    ConeFit       drucker_prager_fit = ConeFit::compression;
    double        cap_pressure       = 0; ///< Pa, drucker-prager-cap only
    double        cap_index          = 0; ///< log volume strain per e-fold of the cap's pressure
    double        relative_density   = 0; ///< bolton only, as those below
    double        void_ratio_min     = 0;
    double        void_ratio_max     = 0;
    double        bolton_q           = 10; ///< strength of the grains
    BoltonFit     bolton_fit         = BoltonFit::triaxial;
    std::string   soil{}; ///< published soil that fills keys left out; empty in a loaded scene, which has all of them

    std::optional<double> softening_length = std::nullopt; ///< m; empty: softens by each point's own density
    double                nonlocal_weight  = 2;            ///< of the mean density in the density that the law sees
    double                young_pressure   = 0; ///< Pa, up to which stiffness grows; 0: one modulus for all pressures

    bool operator==(const Material&) const = default;
};

/// Friction and restitution of an unordered pair of families.
struct Contact
{
    std::array<std::string, 2> between;
    double                     friction    = 0.3;
    double                     restitution = 0.5; ///< body-body only

    double rolling_friction = 0; ///< mu_r, body-body only

    bool touch = true; ///< false: the two pass through each other

    bool operator==(const Contact&) const = default;
};

struct Sphere
{
    Vector3 centre{};
    double  radius = 0; ///< m

    bool operator==(const Sphere&) const = default;
};

/// In a loaded scene exactly one of box and sphere is set: the domain's box if the scene names neither.
struct Region
{
    std::optional<Box>    box;
    std::optional<Sphere> sphere;
    std::vector<Box>      except; ///< excluded boxes

    bool operator==(const Region&) const = default;
};

/// A height (m) as a function of x and y (m).
struct Formula
{
    std::string text;

    bool operator==(const Formula&) const = default;
};

using PlanExtent = std::array<std::array<double, 2>, 2>;

/// Heights on a rectangular lattice: grey values of a PGM, or numbers of a CSV. The first row is at high y.
struct RasterFile
{
    std::string               path;       ///< absolute, or relative to the scene file
    double                    low  = 0;   ///< m, height of black; PGM only
    double                    high = 0;   ///< m, height of white; PGM only
    double                    unit = 1.0; ///< metres per unit of a CSV
    std::optional<PlanExtent> extent;     ///< m, positions of the outermost samples; always set in a loaded scene

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
    std::optional<double> spacing;    ///< m, of a lattice from the region's low corner; replaces points_per_cell
    Vector3               velocity{}; ///< m/s, at the start

    bool operator==(const Terrain&) const = default;
};

struct UniformDiameters
{
    double low  = 0; ///< m
    double high = 0;

    bool operator==(const UniformDiameters&) const = default;
};

/// Log-normal distribution: ln d has this deviation about ln(median); d is truncated to [low, high].
struct LogNormalDiameters
{
    double median    = 0; ///< m
    double deviation = 0; ///< of ln d
    double low       = 0; ///< m
    double high      = 0;

    bool operator==(const LogNormalDiameters&) const = default;
};

/// Number density proportional to d^-exponent in [low, high].
struct PowerLawDiameters
{
    double exponent = 0;
    double low      = 0; ///< m
    double high     = 0;

    bool operator==(const PowerLawDiameters&) const = default;
};

/// Diameter (m) of the sphere of equal volume: one for all, or a distribution by number.
using Diameter = std::variant<double, UniformDiameters, LogNormalDiameters, PowerLawDiameters>;

struct Rocks
{
    std::string                 shape;
    std::string                 material;
    std::string                 from;           ///< absolute path of a saved bed; empty = rocks are sampled and placed
    std::optional<std::int64_t> count;          ///< exactly one of count and solid_fraction is set
    std::optional<double>       solid_fraction; ///< volume of the rocks over that of the region
    Diameter                    diameter = 0.0;
    Region                      region;
    std::optional<Height>       height; ///< surfaces between which the rocks lie
    std::optional<Height>       floor;
    Placement                   placement   = Placement::replace;
    bool                        allow_voids = false; ///< in the sand around rocks that replace it
    std::uint64_t               seed        = 1;

    bool operator==(const Rocks&) const = default;
};

/// Rotation of a body at the start, in one of three forms, or none: the body's axes are then the world's.
struct Orientation
{
    std::optional<Vector3> axis; ///< any length but 0; with angle_deg
    std::optional<double>  angle_deg;
    std::optional<Matrix3> rows; ///< rows of the rotation from body to world
    std::optional<double>  yaw_deg;
    std::optional<double>  camber_deg;

    bool operator==(const Orientation&) const = default;
};

struct Body
{
    std::string              name;
    std::string              shape; ///< a [[shape]] or a built-in wheel
    std::string              material;
    std::optional<double>    diameter;           ///< m, of the sphere of equal volume; default: the shape's own size
    std::optional<double>    density;            ///< kg/m3; exactly one of density, mass and load is set
    std::optional<double>    mass;               ///< kg
    std::optional<double>    load;               ///< N under the scene's gravity
    Vector3                  position{};         ///< m, of the centre of mass; z is 0 if the body stands on_surface
    bool                     on_surface = false; ///< z follows from the surface below the body
    double                   gap        = 0;     ///< m, between that surface and the body's lowest point
    Vector3                  velocity{};         ///< m/s, when first released
    std::optional<double>    rolling_radius;     ///< m; default: radius over the grousers
    std::vector<std::string> lock;               ///< world degrees of freedom held fixed: x y z roll pitch yaw
    Orientation              orientation;        ///< at the start

    bool operator==(const Body&) const = default;
};

struct Output
{
    double every           = 0.02; ///< s, time series
    double snapshots_every = 0;    ///< s; 0 = none

    std::string bed_after; ///< phase at the end of which rocks and sand are saved; empty = none

    bool operator==(const Output&) const = default;
};

/// Intervals at which checkpoints of the whole state are written.
struct CheckpointOptions
{
    double       every_wall  = 600; ///< s of wall time; 0 = never
    double       every_time  = 0;   ///< s of simulated time; 0 = never
    std::int64_t every_steps = 0;   ///< 0 = never
    std::int64_t keep        = 2;   ///< number of newest checkpoints kept

    bool operator==(const CheckpointOptions&) const = default;
};

/// Partitioning of pages in a run on several ranks.
struct Balance
{
    double threshold = 1.15; ///< largest load of a rank over the mean above which pages may be repartitioned

    std::optional<double> least_load; ///< points; load that takes a rank as long as any smaller one; empty means "auto"

    bool operator==(const Balance&) const = default;
};

/// Sand at rest, far from anything that moves, and rocks at rest are left out of the steps.
struct Sleep
{
    std::optional<double> distance;     ///< m from every body; empty = no sand sleeps
    double                speed = 0.01; ///< m/s; sand sleeps if it never moved faster ...
    double                rest  = 0.05; ///< s; ... for this long
    double                load  = 0.2;  ///< change of pressure that wakes it, over the mean pressure on the bed's base

    std::optional<double> rock_speed;      ///< m/s; rocks sleep if they went no further than at this speed ...; or none
    double                rock_rest = 0.1; ///< s; ... in this time
    double                rock_load = 0.1; ///< change of load that wakes a rock, over the load that it carries

    bool operator==(const Sleep&) const = default;
};

/// Reference values of the right answer. `tread study` compares runs with them; no run reads them.
struct Reference
{
    ReferenceForm form = ReferenceForm::none;
    std::string   file; ///< of times and values; absolute when loaded; empty = none

    bool operator==(const Reference&) const = default;
};

/// File locations of tables ("sand.toml:41"), by their names in messages ("rocks[0]", "body.wheel"), for errors that
/// appear only when the world is built. Not part of the scene's content, so any two compare equal.
struct Lines
{
    std::map<std::string, std::string> of;

    bool operator==(const Lines& /*other*/) const { return true; }
};

/// A value that a material took from its soil.
struct SoilValue
{
    std::string key;   ///< of [[material]]
    std::string value; ///< TOML
    std::string source;
};

struct SoilUse
{
    std::string            material; ///< its table in messages, "material.sand"
    std::string            soil;
    std::vector<SoilValue> taken;
};

/// What materials took from soils, for users to read. The values are those of the materials; this is not part of the
/// scene's content, so any two compare equal.
struct SoilUses
{
    std::vector<SoilUse> of;

    bool operator==(const SoilUses& /*other*/) const { return true; }
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
    std::vector<Joint>    joints;
    std::vector<Phase>    phases;
    Output                output;
    CheckpointOptions     checkpoint;
    Balance               balance;
    Sleep                 sleep;
    Reference             reference;
    std::string           directory; ///< of the scene file; mesh paths are relative to it
    Lines                 lines;
    SoilUses              soils;

    bool operator==(const Scene&) const = default;
};

/// Returns the softening length of the materials that have one, m, the same for all; 0 if none has.
inline double softening_length(const Scene& scene)
{
    double length = 0;
    for (const Material& material : scene.materials)
    {
        length = std::max(length, material.softening_length.value_or(0));
    }
    return length;
}

} // namespace tread::scene
