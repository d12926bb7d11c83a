#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "scene/scene.hpp"
#include "shape/mesh.hpp"

// What a stone looks like, in numbers that do not depend on how it lies or how large it is.
namespace tread::shape
{

/// Sides of the box that a stone fills when it lies on its flattest side and is squared up between callipers: minor is
/// its smallest calliper width; intermediate the smallest width of the silhouette along that direction; major the
/// width across both. The ratios are Zingg's (1935), after the review of Blott & Pye (2008), Sedimentology 55:31.
struct Extents
{
    Eigen::Vector3d lengths; ///< m: major, intermediate, minor
    Eigen::Matrix3d axes;    ///< their directions, one a column, right-handed
};

/// Form factors of a closed mesh, all 1 for a sphere (and all but the sphericity for a cube).
struct Form
{
    double aspect;     ///< minor over major
    double elongation; ///< intermediate over major
    double sphericity; ///< surface of the sphere of equal volume over the mesh's (Wadell 1932, J. Geol. 40:443)
    double solidity;   ///< volume over that of the convex hull
};

/// Of the convex hull of points. The widths are minimal to within 1e-6 of themselves.
Extents extents(const std::vector<Eigen::Vector3d>& hull_vertices);

/// InputError if the mesh is flat.
Form form_of(const TriangleMesh& mesh);

double sphericity(const TriangleMesh& mesh);

struct NamedForm
{
    std::string name;
    Form        form;
};

/// One line of text a mesh, under a heading; then mean, least and most of each column if there are several.
std::string form_table(const std::vector<NamedForm>& forms);

/// Of each member of a family of rocks. InputError if one cannot be made.
std::vector<NamedForm> family_forms(const scene::Shape& shape);

} // namespace tread::shape
