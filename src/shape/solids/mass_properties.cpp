#include "shape/solids/mass_properties.hpp"

#include "shape/mesh/triangle.hpp"

namespace tread::shape
{

// Moments of the tetrahedron (o, a, b, c) about o, with volume v = a . (b x c) / 6:
//   int x dV = v/4 s,  int x x^T dV = v/20 (a a^T + b b^T + c c^T + s s^T),  s = a + b + c
// (Tonon 2004, J. Math. Stat. 1:8, in covariance form). o is the middle of the box, to keep the sums small.
MassProperties mass_properties(const TriangleMesh& mesh)
{
    const Bounds          box    = bounds(mesh);
    const Eigen::Vector3d origin = 0.5 * (box.low + box.high);

    double          volume = 0;
    Eigen::Vector3d first  = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        const Eigen::Vector3d a       = corner(mesh, t, 0) - origin;
        const Eigen::Vector3d b       = corner(mesh, t, 1) - origin;
        const Eigen::Vector3d c       = corner(mesh, t, 2) - origin;
        const Eigen::Vector3d sum     = a + b + c;
        const double          portion = a.dot(b.cross(c)) / 6;
        volume += portion;
        first += portion / 4 * sum;
        second += portion / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }

    const Eigen::Vector3d centre     = first / volume;
    const Eigen::Matrix3d covariance = second - volume * centre * centre.transpose();
    const Eigen::Matrix3d inertia    = covariance.trace() * Eigen::Matrix3d::Identity() - covariance;
    return {volume, origin + centre, inertia};
}

} // namespace tread::shape
