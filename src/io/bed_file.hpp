#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/provenance.hpp"

// bed.h5: rocks at rest, saved by one run as the initial state of another.
namespace tread::io
{

/// Rocks that share a template and a material.
struct BedKind
{
    std::string shape;    ///< the [[shape]] that generated the rocks
    std::string member;   ///< the rock of that family, by the name of its template
    std::string material; ///< in the scene that made the bed
    double      inertia;  ///< kg m2, trace of the template's inertia at scale 1 and density 1; identifies its geometry
    double      density;  ///< kg/m3
    double      young;    ///< Pa
    double      poisson;
};

/// Friction records of pairs in contact (kernels/dem/contact/patch_kern.hpp). A rock is numbered by its row, a wall of
/// the domain by the number of rocks plus 0 to 5: x low, x high, y low, y high, bottom, top.
struct BedContacts
{
    std::vector<std::int32_t> pair;            ///< [n][2]
    std::vector<double>       tangential;      ///< [n][3] N, on the first
    std::vector<double>       normal;          ///< [n][3] towards the first
    std::vector<double>       torsion;         ///< [n] N m, on the first about the normal
    std::vector<double>       stiffness;       ///< [n] N/m
    std::vector<double>       twist_stiffness; ///< [n] N m/rad

    std::vector<double> place; ///< [n][3] m, from the first's centre in its frame; for pairs with several contacts

    std::vector<double> rolling;           ///< [n][3] N m, on the first; zero without rolling resistance
    std::vector<double> rolling_stiffness; ///< [n] N m/rad
};

/// A material of the scene that made the bed.
struct BedMaterial
{
    std::string name;
    double      density; ///< kg/m3
    double      young;   ///< Pa
    double      poisson;
    double      young_pressure; ///< Pa
};

/// Sand points of the bed. When loaded, their present volume becomes the reference of strain, which preserves volume
/// times stress and so all forces.
struct BedPoints
{
    double                    grid_spacing = 0; ///< m
    std::vector<BedMaterial>  materials;
    std::vector<std::int32_t> material;      ///< [n] index into materials
    std::vector<double>       position;      ///< [n][3] m
    std::vector<double>       volume;        ///< [n] m3, present
    std::vector<double>       mass;          ///< [n] kg
    std::vector<double>       stress;        ///< [n][6] Pa, Cauchy, tension positive: xx, yy, zz, yz, xz, xy
    std::vector<double>       plastic_shear; ///< [n] equivalent plastic shear strain
};

struct BedFile
{
    std::vector<BedKind>      kinds;
    std::vector<std::int32_t> kind;        ///< [n] index into kinds
    std::vector<double>       position;    ///< [n][3] m, centre of mass
    std::vector<double>       orientation; ///< [n][4] quaternion w, x, y, z, body to world
    std::vector<double>       scale;       ///< [n] of the template
    std::vector<double>       diameter;    ///< [n] m, of the sphere of equal volume
    BedContacts               contacts;
    BedPoints                 points; ///< none if the bed has no sand

    std::size_t size() const { return kind.size(); }
};

/// Writes a bed; the file gets its name once it is complete. EnvironmentError if it cannot be written.
void write_bed(const std::string& path, const BedFile& bed, const Provenance& provenance = {});

/// Reads a bed. EnvironmentError if it cannot be read, is not a bed, or holds numbers out of range.
BedFile read_bed(const std::string& path);

} // namespace tread::io
