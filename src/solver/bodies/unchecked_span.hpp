#pragma once

namespace tread::solver
{

/// Motion that bounds displacements until the next check.
struct MotionBound
{
    double speed;        ///< m/s, the largest of anything
    double acceleration; ///< m/s2, the largest by weight
};

/// Time (s) for which a list of pairs needs no check, where the smallest body has this radius (m).
double unchecked_span(double smallest_radius, const MotionBound& motion);

} // namespace tread::solver
