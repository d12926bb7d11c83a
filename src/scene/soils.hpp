#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/words.hpp"

// Library of published soils: the one place of their constants. [[material]] `soil` takes them (soil_filling.hpp),
// `tread soils` prints them and docs/soils.md lists them (soil_text.hpp).
namespace tread::scene
{

/// A constant of a soil. In Soil::constants, `key` is the key of [[material]] that takes it, or `grain_density`; in
/// Soil::bevameter, the name in the formulas of Wong and Reece.
struct SoilConstant
{
    const char* key;
    double      value;  ///< in `unit`
    const char* unit;   ///< empty if it has none
    const char* source; ///< begins with "assumed" where no test says so
};

struct Soil
{
    const char*                   name;       ///< as scenes write it
    const char*                   what;       ///< one line
    MaterialModel                 model;      ///< that the constants are for
    std::span<const SoilConstant> constants;  ///< of the model
    std::span<const SoilConstant> bevameter;  ///< of Bekker's and Janosi's formulas; empty where none is published
    const char*                   references; ///< full citations of the sources, and where they were read
};

std::span<const Soil> soils();

/// Soil of this name; nullptr if there is none.
const Soil* find_soil(std::string_view name);

std::vector<std::string> soil_names();

/// A constant of the soil's model; empty if the soil lacks it.
std::optional<double> constant_of(const Soil& soil, std::string_view key);

} // namespace tread::scene
