#include <numeric>

#include "backend/instantiate.hpp"
#include "decomp/combine.hpp"
#include "solver/mpm_solver.hpp"

// Accounts for sand that leaves the domain.
namespace tread::solver
{

/// The `left` points of this rank are stored behind the others; a census counts them as one page.
template<class Exec, class Real>
void MpmSolver<Exec, Real>::keep_account_of(std::int64_t left)
{
    double row[mpm::census_count] = {};
    if (left > 0)
    {
        std::vector<std::int32_t> places(static_cast<std::size_t>(left));
        std::iota(places.begin(), places.end(), static_cast<std::int32_t>(points_.count));
        Array<Exec, std::int32_t> place(exec_, "points that left"), range(exec_, "range of points that left");
        place.assign(places);
        range.assign({0, static_cast<std::int32_t>(left)});
        mpm::PagesView page = pages();
        page.point_pages    = 1;
        page.first_point    = range.data();
        page.point_at       = place.data();
        census_rows_.resize(mpm::census_count);
        mpm::take_census(exec_, points_.view(), page, materials_.data(), census_rows_.data());
        copy_to_host(exec_, row, census_rows_.data(), sizeof(row));
    }
    if (ranks_) { decomp::combine(ranks_->communicator(), row, mpm::census_count, 0); }
    for (std::size_t c = 0; c < left_.size(); ++c) { left_[c] += row[c]; }
    mass_ -= row[mpm::census_mass];
}

#define TREAD_INSTANTIATE(Exec, Real) template void MpmSolver<Exec, Real>::keep_account_of(std::int64_t)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
