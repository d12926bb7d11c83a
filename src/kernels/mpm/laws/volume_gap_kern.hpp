#pragma once

#include "backend/vector.hpp"

namespace tread::mpm
{

/// Closes the volume gap: compression first closes the volume opened at the apex and only then loads the grains
/// (hypoelastic analogue of Tampubolon et al. 2017, ACM Trans. Graph. 36:105). Reduces `gap`; returns the tension to
/// add to the mean of the trial stress.
template<class Real>
TREAD_HD Real close_gap(Real mean, Real bulk_modulus, Real& gap)
{
    if (!(mean < 0 && gap > 0)) { return 0; }
    const Real wanted = -mean / bulk_modulus;
    if (wanted >= gap)
    {
        const Real closed = gap;
        gap               = 0;
        return bulk_modulus * closed;
    }
    gap -= wanted;
    return -mean;
}

} // namespace tread::mpm
