#pragma once

#include "scene/spelling.hpp"
#include "scene/words.hpp"

// Words of the enumerations of a scene, as users write them.
namespace tread::scene
{

template<>
inline constexpr auto spellings<WallKind> = spell<WallKind>({{WallKind::slip, "slip"},
                                                             {WallKind::fixed, "fixed"},
                                                             {WallKind::frictional, "frictional"},
                                                             {WallKind::open, "open"},
                                                             {WallKind::rough, "rough"}});

template<>
inline constexpr auto spellings<Precision> = spell<Precision>({{Precision::single_, "single"},
                                                               {Precision::double_, "double"}});

template<>
inline constexpr auto spellings<Transfer> =
    spell<Transfer>({{Transfer::flip, "flip"}, {Transfer::apic, "apic"}, {Transfer::aflip, "aflip"}});

template<>
inline constexpr auto spellings<ShapeFunctions> = spell<ShapeFunctions>({{ShapeFunctions::quadratic, "quadratic"},
                                                                         {ShapeFunctions::linear, "linear"}});

template<>
inline constexpr auto spellings<PointMotion> = spell<PointMotion>({{PointMotion::supported, "supported"},
                                                                   {PointMotion::ballistic, "ballistic"},
                                                                   {PointMotion::frozen, "frozen"}});

template<>
inline constexpr auto spellings<HertzFactor> = spell<HertzFactor>({{HertzFactor::standard, "standard"},
                                                                   {HertzFactor::paper_eq7, "paper-eq7"}});

template<>
inline constexpr auto spellings<VolumeStrain> = spell<VolumeStrain>({{VolumeStrain::point, "point"},
                                                                     {VolumeStrain::cell_average, "cell-average"}});

template<>
inline constexpr auto spellings<PointRadius> = spell<PointRadius>({{PointRadius::sphere, "sphere"},
                                                                   {PointRadius::semi_domain, "semi-domain"}});

template<>
inline constexpr auto spellings<MaterialModel> = spell<MaterialModel>({
#define TREAD_ROW(name, word, kind) {MaterialModel::name, word},
    TREAD_MATERIAL_MODELS(TREAD_ROW)
#undef TREAD_ROW
});

template<>
inline constexpr auto spellings<BoltonFit> = spell<BoltonFit>({{BoltonFit::triaxial, "triaxial"},
                                                               {BoltonFit::plane_strain, "plane-strain"}});

template<>
inline constexpr auto spellings<ConeFit> = spell<ConeFit>({{ConeFit::compression, "compression"},
                                                           {ConeFit::extension, "extension"},
                                                           {ConeFit::plane_strain, "plane-strain"}});

template<>
inline constexpr auto spellings<Placement> = spell<Placement>({{Placement::replace, "replace"},
                                                               {Placement::rain, "rain"},
                                                               {Placement::grid, "grid"},
                                                               {Placement::points, "points"}});

template<>
inline constexpr auto spellings<StopRule> = spell<StopRule>({{StopRule::duration, "duration"},
                                                             {StopRule::equilibrium, "equilibrium"},
                                                             {StopRule::lowered, "lowered"}});

template<>
inline constexpr auto spellings<JointType> = spell<JointType>({{JointType::revolute, "revolute"},
                                                               {JointType::prismatic, "prismatic"},
                                                               {JointType::spherical, "spherical"},
                                                               {JointType::fixed, "fixed"},
                                                               {JointType::differential, "differential"},
                                                               {JointType::spring, "spring"}});

template<>
inline constexpr auto spellings<NarrowPhase> = spell<NarrowPhase>({{NarrowPhase::sdf, "sdf"},
                                                                   {NarrowPhase::rays, "rays"}});

template<>
inline constexpr auto spellings<GrouserShape> = spell<GrouserShape>({{GrouserShape::straight, "straight"},
                                                                     {GrouserShape::chevron, "chevron"},
                                                                     {GrouserShape::curved, "curved"}});

template<>
inline constexpr auto
    spellings<ReferenceForm> = spell<ReferenceForm>({{ReferenceForm::none, "none"},
                                                     {ReferenceForm::hertz_impact, "hertz-impact"},
                                                     {ReferenceForm::fixed_free_bar, "fixed-free-bar"},
                                                     {ReferenceForm::geostatic, "geostatic"},
                                                     {ReferenceForm::weight, "weight"},
                                                     {ReferenceForm::rolling_ball, "rolling-ball"},
                                                     {ReferenceForm::run_out, "run-out"},
                                                     {ReferenceForm::plate_sinkage, "plate-sinkage"},
                                                     {ReferenceForm::cone_penetration, "cone-penetration"},
                                                     {ReferenceForm::direct_shear, "direct-shear"},
                                                     {ReferenceForm::ring_shear, "ring-shear"},
                                                     {ReferenceForm::triaxial, "triaxial"},
                                                     {ReferenceForm::oedometer, "oedometer"},
                                                     {ReferenceForm::repose, "repose"}});

} // namespace tread::scene
