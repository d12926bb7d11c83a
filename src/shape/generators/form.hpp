#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "scene/scene.hpp"
#include "shape/mesh/mesh.hpp"

// Shape descriptors of stones, independent of orientation and size.
namespace tread::shape
{

/// Box that a stone fills when measured with callipers: minor is its smallest width; intermediate the smallest width of
/// the silhouette along the minor direction; major the width perpendicular to both. The ratios are Zingg's (1935),
/// after the review of Blott & Pye (2008), Sedimentology 55:31.
struct Extents
{
    Eigen::Vector3d lengths; ///< m: major, intermediate, minor
    Eigen::Matrix3d axes;    ///< their directions, one per column, right-handed
};

/// Form factors of a closed mesh, all 1 for a sphere (and all except sphericity for a cube).
struct Form
{
    double aspect;     ///< minor over major
    double elongation; ///< intermediate over major
    double sphericity; ///< surface of the sphere of equal volume over the mesh's (Wadell 1932, J. Geol. 40:443)
    double solidity;   ///< volume over that of the convex hull
};

/// Extents from the vertices of a convex hull. Widths are minimal to a relative 1e-6.
Extents extents(const std::vector<Eigen::Vector3d>& hull_vertices);

/// Form factors of a mesh. InputError if it is flat.
Form form_of(const TriangleMesh& mesh);

double sphericity(const TriangleMesh& mesh);

struct NamedForm
{
    std::string name;
    Form        form;
};

/// Formats one line per mesh under a heading, then mean, minimum and maximum of each column if there are several.
std::string form_table(const std::vector<NamedForm>& forms);

/// Form factors of each member of a family of rocks. InputError if one cannot be generated.
std::vector<NamedForm> family_forms(const scene::Shape& shape);

} // namespace tread::shape
