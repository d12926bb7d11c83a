#pragma once

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
enum class MaterialModel
{
    elastic,
    mohr_coulomb,
    drucker_prager,
    rigid
};

/// Models of granular flow, with friction angle, dilation angle and cohesion.
constexpr bool is_granular(MaterialModel model)
{
    return model == MaterialModel::mohr_coulomb || model == MaterialModel::drucker_prager;
}

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
    run_out
};

} // namespace tread::scene
