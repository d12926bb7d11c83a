#pragma once

#include <array>
#include <cstddef>

// Enumerations of a scene; spellings.hpp has their words.
namespace tread::scene
{

enum class WallKind
{
    slip,
    fixed,
    frictional,
    open,
    rough
};
enum class Precision
{
    single_,
    double_
};
enum class Transfer
{
    flip,
    apic,
    aflip
};
enum class ShapeFunctions
{
    quadratic,
    linear
};
enum class PointMotion
{
    supported,
    ballistic,
    frozen
};
enum class HertzFactor
{
    standard,
    paper_eq7
};
/// Source of the volumetric strain rate in a point's law.
enum class VolumeStrain
{
    point,       ///< divergence of the velocity at the point
    cell_average ///< mean of it over the points of the cell
};
enum class PointRadius
{
    sphere,
    semi_domain
};
enum class MaterialKind
{
    elastic,
    granular, ///< flows: friction angle, dilation angle, cohesion, and a plastic state of the points
    rigid
};

/// Table of the material models: ROW(name, word in a scene, kind).
#define TREAD_MATERIAL_MODELS(ROW)                                                                                     \
    ROW(elastic, "elastic", elastic)                                                                                   \
    ROW(mohr_coulomb, "mohr-coulomb", granular)                                                                        \
    ROW(drucker_prager, "drucker-prager", granular)                                                                    \
    ROW(drucker_prager_cap, "drucker-prager-cap", granular)                                                            \
    ROW(bolton, "bolton", granular)                                                                                    \
    ROW(rigid, "rigid", rigid)

enum class MaterialModel
{
#define TREAD_ROW(name, word, kind) name,
    TREAD_MATERIAL_MODELS(TREAD_ROW)
#undef TREAD_ROW
};

constexpr MaterialKind material_kind(MaterialModel model)
{
#define TREAD_ROW(name, word, kind) MaterialKind::kind,
    constexpr std::array kinds{TREAD_MATERIAL_MODELS(TREAD_ROW)};
#undef TREAD_ROW
    return kinds[static_cast<std::size_t>(model)];
}

constexpr bool is_granular(MaterialModel model) { return material_kind(model) == MaterialKind::granular; }

/// Stress states of the tests to which Bolton's friction angle is fitted.
enum class BoltonFit
{
    triaxial,
    plane_strain
};
/// Stress states in which the Drucker-Prager cone matches the Mohr-Coulomb hexagon.
enum class ConeFit
{
    compression,
    extension,
    plane_strain
};
enum class Placement
{
    replace,
    rain,
    grid,
    points
};

/// Whether rocks placed this way replace sand points.
constexpr bool takes_sand(Placement placement)
{
    return placement == Placement::replace || placement == Placement::points;
}

enum class StopRule
{
    duration,
    equilibrium,
    lowered
};
/// Method that finds the penetration depth of surface nodes.
enum class NarrowPhase
{
    sdf, ///< distance field of the other body
    rays ///< ray from each node to the triangles of the other body
};
enum class GrouserShape
{
    straight,
    chevron,
    curved
};
enum class JointType
{
    revolute,
    prismatic,
    spherical,
    fixed,
    differential,
    spring
};
/// Closed-form solutions that follow from the scene; docs/study.md lists their inputs.
enum class ReferenceForm
{
    none,
    hertz_impact,
    fixed_free_bar,
    geostatic,
    weight,
    rolling_ball,
    run_out,
    plate_sinkage,
    cone_penetration,
    direct_shear,
    ring_shear,
    triaxial,
    oedometer,
    repose
};

} // namespace tread::scene
