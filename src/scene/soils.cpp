#include "scene/soils.hpp"

#include <algorithm>
#include <array>

namespace tread::scene
{
namespace
{

constexpr const char* no_unit = "";

constexpr std::array grc_1{
    SoilConstant{"grain_density", 2580, "kg/m3", "Oravec et al. 2010"},
    SoilConstant{"void_ratio_min", 0.365, no_unit, "Oravec et al. 2010: densest at 1890 kg/m3"},
    SoilConstant{"void_ratio_max", 0.6125, no_unit, "Oravec et al. 2010: loosest at 1600 kg/m3"},
    SoilConstant{
        "friction_angle_deg", 32.8, "degrees",
        "fitted: gives the triaxial angles of the loosest and the densest sand of Oravec et al. 2010, 29.8 and "
        "44.4, as 29.8 and 44.8"},
    SoilConstant{"bolton_q", 10, no_unit, "Bolton 1986: quartz"},
    SoilConstant{"cohesion", 0, "Pa", "assumed: dry sand"},
    SoilConstant{"young", 1.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array grc_3{
    SoilConstant{"grain_density", 2630, "kg/m3", "He et al. 2013"},
    SoilConstant{"density", 1520, "kg/m3", "He et al. 2013: loosest of 1520 to 1940"},
    SoilConstant{"friction_angle_deg", 37.8, "degrees",
                 "He et al. 2013: least of 37.8 to 47.8 (triaxial); that it is the loosest soil's is assumed"},
    SoilConstant{"void_ratio_min", 0.356, no_unit, "He et al. 2013: densest at 1940 kg/m3"},
    SoilConstant{"void_ratio_max", 0.730, no_unit, "He et al. 2013: loosest at 1520 kg/m3"},
    SoilConstant{"cohesion", 0, "Pa", "assumed: none was found"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array jsc_1a{
    SoilConstant{"grain_density", 2850, "kg/m3", "Zeng et al. 2007"},
    SoilConstant{"density", 1680, "kg/m3", "Zeng et al. 2007"},
    SoilConstant{"friction_angle_deg", 35, "degrees",
                 "Zeng et al. 2007; 42.9 to 48.8 in triaxial tests at 1630 kg/m3 (Alshibli and Hasan 2009)"},
    SoilConstant{"cohesion", 170, "Pa",
                 "Zeng et al. 2007; 1400 to 2400 in triaxial tests at 1630 kg/m3 (Alshibli and Hasan 2009)"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array fjs_1{
    SoilConstant{"density", 1600, "kg/m3", "Ishigami et al. 2007"},
    SoilConstant{"friction_angle_deg", 37.2, "degrees", "Ishigami et al. 2007; 39.4 in Maki et al. 2014"},
    SoilConstant{"cohesion", 800, "Pa", "Ishigami et al. 2007; 8130 in Maki et al. 2014"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array fjs_1_bevameter{
    SoilConstant{"k_c", 1370, "N/m^(n+1)", "Ishigami et al. 2007"},
    SoilConstant{"k_phi", 8.14e5, "N/m^(n+2)", "Ishigami et al. 2007"},
    SoilConstant{"exponent", 1.0, no_unit, "Ishigami et al. 2007"},
    SoilConstant{"cohesion", 800, "Pa", "Ishigami et al. 2007"},
    SoilConstant{"friction_angle_deg", 37.2, "degrees", "Ishigami et al. 2007"},
    SoilConstant{"shear_length", 0.036, "m", "Ishigami et al. 2007: without slip angle"},
};

constexpr std::array kls_1{
    SoilConstant{"friction_angle_deg", 44.91, "degrees", "Ryu et al. 2018: direct shear"},
    SoilConstant{"cohesion", 1850, "Pa", "Ryu et al. 2018: direct shear"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array toyoura{
    SoilConstant{"grain_density", 2650, "kg/m3", "Verdugo and Ishihara 1996"},
    SoilConstant{"void_ratio_min", 0.597, no_unit, "Verdugo and Ishihara 1996"},
    SoilConstant{"void_ratio_max", 0.977, no_unit, "Verdugo and Ishihara 1996"},
    SoilConstant{"friction_angle_deg", 31.15, "degrees",
                 "Dafalias and Manzari 2004: M = 1.25 in triaxial compression, sin phi = 3 M/(6 + M)"},
    SoilConstant{"bolton_q", 10, no_unit, "Bolton 1986: quartz and feldspar"},
    SoilConstant{"cohesion", 0, "Pa", "assumed: dry sand"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array ottawa{
    SoilConstant{"grain_density", 2650, "kg/m3", "Santamarina and Cho 2001"},
    SoilConstant{"void_ratio_min", 0.502, no_unit, "Santamarina and Cho 2001"},
    SoilConstant{"void_ratio_max", 0.742, no_unit, "Santamarina and Cho 2001"},
    SoilConstant{"friction_angle_deg", 28, "degrees", "Santamarina and Cho 2001: of the critical state"},
    SoilConstant{"bolton_q", 10, no_unit, "Bolton 1986: quartz"},
    SoilConstant{"cohesion", 0, "Pa", "assumed: dry sand"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array hit{
    SoilConstant{"density", 1605, "kg/m3", "Ding et al. 2011"},
    SoilConstant{"friction_angle_deg", 31.9, "degrees", "Ding et al. 2011"},
    SoilConstant{"cohesion", 0, "Pa", "assumed: dry sand; the intercept of 250 Pa of Ding et al. 2011 is not taken"},
    SoilConstant{"young", 5.0e6, "Pa", "assumed"},
    SoilConstant{"poisson", 0.3, no_unit, "assumed"},
};

constexpr std::array hit_bevameter{
    SoilConstant{"k_c", 15600, "N/m^(n+1)", "Ding et al. 2011"},
    SoilConstant{"k_phi", 2.407e6, "N/m^(n+2)", "Ding et al. 2011"},
    SoilConstant{"exponent", 1.1, no_unit, "Ding et al. 2011"},
    SoilConstant{"cohesion", 250, "Pa", "Ding et al. 2011"},
    SoilConstant{"friction_angle_deg", 31.9, "degrees", "Ding et al. 2011"},
    SoilConstant{"shear_length", 0.0114, "m", "Ding et al. 2011: middle of 0.0097 to 0.0131"},
};

constexpr std::array library{
    Soil{
        "GRC-1",
        "Lunar simulant of NASA Glenn for wheels, silica sand",
        MaterialModel::bolton,
        grc_1,
        {},
        "H. A. Oravec, X. Zeng and V. M. Asnani 2010, J. Terramech. 47(6), 361-377, as in "
        "configs/validation/scenes/mgru3_density.toml, densities also in the Planetary Simulant Database; M. D. Bolton "
        "1986, Geotechnique 36(1), 65-78"},
    Soil{"GRC-3",
         "Lunar simulant of NASA Glenn for excavation, sand and silt",
         MaterialModel::mohr_coulomb,
         grc_3,
         {},
         "C. He, X. Zeng and A. Wilkinson 2013, J. Aerosp. Eng. 26(3), 528-534: grains from the Planetary Simulant "
         "Database, densities and angles from L. Gasteiner's Lunar Regolith Database, which cite it"},
    Soil{"JSC-1A",
         "Lunar simulant of NASA Johnson, basaltic ash",
         MaterialModel::mohr_coulomb,
         jsc_1a,
         {},
         "X. Zeng, L. Burnoski, J. Agui and A. Wilkinson 2007, AIAA Aerospace Sciences Meeting, NTRS 20070018151, from "
         "a "
         "summary of it; K. A. Alshibli and A. Hasan 2009, J. Geotech. Geoenviron. Eng. 135(5), 673-679, from L. "
         "Gasteiner's Lunar Regolith Database"},
    Soil{"FJS-1", "Lunar simulant of JAXA, basalt", MaterialModel::mohr_coulomb, fjs_1, fjs_1_bevameter,
         "G. Ishigami, A. Miwa, K. Nagatani and K. Yoshida 2007, J. Field Robotics 24(3), 233-250, whose regolith "
         "simulant is equivalent to FJS-1: values from public codes that use them, the paper from memory; S. Maki et "
         "al. "
         "2014, from L. Gasteiner's Lunar Regolith Database"},
    Soil{"KLS-1",
         "Lunar simulant of KICT, basalt; density to be given",
         MaterialModel::mohr_coulomb,
         kls_1,
         {},
         "B.-H. Ryu, C.-C. Wang and I. Chang 2018, J. Aerosp. Eng. 31(1), 04017083, from L. Gasteiner's Lunar Regolith "
         "Database"},
    Soil{"Toyoura",
         "Standard sand of Japan",
         MaterialModel::bolton,
         toyoura,
         {},
         "R. Verdugo and K. Ishihara 1996, Soils Found. 36(2), 81-91, and Y. F. Dafalias and M. T. Manzari 2004, J. "
         "Eng. "
         "Mech. 130(6), 622-634, from public codes that cite them; M. D. Bolton 1986, Geotechnique 36(1), 65-78"},
    Soil{"Ottawa-20-30",
         "Standard sand of ASTM C778, 0.6 to 0.85 mm",
         MaterialModel::bolton,
         ottawa,
         {},
         "J. C. Santamarina and G. C. Cho 2001, Geotech. Test. J. 24(2), 185-192: from memory, without access to the "
         "text; M. D. Bolton 1986, Geotechnique 36(1), 65-78"},
    Soil{"HIT", "Dry loose sand of the Harbin Institute of Technology's wheel rig", MaterialModel::mohr_coulomb, hit,
         hit_bevameter, "L. Ding et al. 2011, J. Terramech. 48(1), 27-45, as in configs/validation"},
};

} // namespace

std::span<const Soil> soils() { return library; }

const Soil* find_soil(std::string_view name)
{
    const auto found =
        std::find_if(library.begin(), library.end(), [&](const Soil& soil) { return soil.name == name; });
    return found == library.end() ? nullptr : &*found;
}

std::vector<std::string> soil_names()
{
    std::vector<std::string> names;
    names.reserve(library.size());
    for (const Soil& soil : library) { names.emplace_back(soil.name); }
    return names;
}

std::optional<double> constant_of(const Soil& soil, std::string_view key)
{
    for (const SoilConstant& constant : soil.constants)
    {
        if (constant.key == key) { return constant.value; }
    }
    return std::nullopt;
}

} // namespace tread::scene
