#pragma once

#include <cstdint>
#include <vector>

#include "decomp/decomposition.hpp"
#include "decomp/exchange.hpp"
#include "kernels/mpm/pages/leaving.hpp"

namespace tread::decomp
{

/// Sends points, with all their fields, to the ranks that own their pages. Collective.
template<class Exec, class Real>
class Migration
{
public:
    explicit Migration(Decomposition<Exec>& decomposition);

    /// Migrates points; returns how many changed rank, over all ranks. Points that stay come first, in their order,
    /// then arrivals by rank, each rank's in its order. A page without an owner that sand enters is assigned to the
    /// rank with most of its points, the lowest of equals. Point ranges must be rebuilt afterwards. With Checksums::on,
    /// NumericalError if count, ids or masses of all points changed.
    std::int64_t run(mpm::Points<Exec, Real>& points, const mpm::GridGeometry& geometry,
                     mpm::OrderScratch<Exec, Real>& scratch);

    /// Ids of the points sent to each rank in the last run, ascending, so that data attached to them can follow.
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
