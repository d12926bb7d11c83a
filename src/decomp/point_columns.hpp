#pragma once

#include "decomp/rows.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::decomp
{

/// Columns of a point as one row: all planes of all its fields.
template<class Exec, class Real>
Columns point_columns(mpm::Points<Exec, Real>& points)
{
    Columns columns;
    points.for_each_field([&](auto& field, int components)
                          { columns.add(planes(field.data(), points.stride, components)); });
    return columns;
}

} // namespace tread::decomp
