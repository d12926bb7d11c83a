#pragma once

// The words that a scene chooses from; keys.cpp and its like spell them, in this order.
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
/// What the volumetric strain rate of a point's law is.
enum class VolumeStrain
{
    point,       ///< the velocity's divergence there
    cell_average ///< its mean over the points of the cell
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

/// The models that flow: with friction angle, dilation angle and cohesion.
constexpr bool is_granular(MaterialModel model)
{
    return model == MaterialModel::mohr_coulomb || model == MaterialModel::drucker_prager;
}

/// The stress states in which Drucker and Prager's cone is as strong as Mohr and Coulomb's hexagon.
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

/// Whether rocks so placed stand where points of sand stood before.
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
/// How bodies tell how deep their surface nodes are in each other.
enum class NarrowPhase
{
    sdf, ///< by the other one's distance field
    rays ///< by a ray from each node to the other one's triangles
};
enum class GrouserShape
{
    straight,
    chevron,
    curved
};
/// A closed form whose answer follows from the scene: docs/study.md says from what.
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
