#pragma once

#include <cstdint>
#include <vector>

#include "decomp/decomposition.hpp"
#include "decomp/exchange.hpp"
#include "kernels/mpm/pages/leaving.hpp"

namespace tread::decomp
{

/// Brings points, with all their fields, to the ranks that own their pages. Collective.
template<class Exec, class Real>
class Migration
{
public:
    explicit Migration(Decomposition<Exec>& decomposition);

    /// Points that stay come first, in their order; then those that come, by rank, each rank's in its order. A page
    /// that nobody owns becomes that of the rank with most of its points, of equals the lowest. Ranges of points have
    /// to be made anew. Returns how many points of all ranks changed their rank. With Checksums::on NumericalError
    /// where count, ids or masses of all points together are not what they were.
    std::int64_t run(mpm::Points<Exec, Real>& points, const mpm::GridGeometry& geometry,
                     mpm::OrderScratch<Exec, Real>& scratch);

    /// Ids of the points that went to each rank in the last run, ascending: what belongs to them can follow.
    const std::vector<std::vector<std::uint32_t>>& migrated_out() const { return migrated_out_; }

private:
    void adopt_pages();
    void note_migrated_out(mpm::Points<Exec, Real>& points, const std::vector<std::int32_t>& owner);

    Decomposition<Exec>& decomposition_;
    mpm::Leaving<Exec>   leaving_;
    Exchange<Exec>       exchange_;

    Array<Exec, std::uint32_t>              ids_;
    std::vector<std::vector<std::uint32_t>> migrated_out_;
};

} // namespace tread::decomp
