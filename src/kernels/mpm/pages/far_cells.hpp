#pragma once

#include "kernels/mpm/pages/leaving.hpp"

// Points outside the pages of their rank, between two sorts.
namespace tread::mpm
{

/// Spacings: points of a rank are never as far outside the pages that it owned at the last sort. In the cells that
/// mark_far_cells leaves out they are less than one outside, and move less than one until the report that tells of it.
constexpr double farthest_outside = 2;

/// Sets Pages::far_cells: cells of pages that this rank (`self`) does not own, except those that share a face with a
/// page that it owns. A point that enters one asks for a sort (CellChange::rim). Call when the pages were rebuilt.
template<class Exec>
void mark_far_cells(const Exec& exec, Pages<Exec>& pages, const PageOwnersView& owners, std::int32_t self);

} // namespace tread::mpm
